# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Comparisons of models by given scores and errors."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from pam_ros.identification.search.compare import (
    is_accepted,
    is_no_worse,
    is_significant,
    is_sufficient,
)
from pam_ros.identification.search.criteria import CRITERIA
from pam_ros.identification.search.setting import Errors

pytestmark = [pytest.mark.slow, pytest.mark.needs_numba]


def strained(model, chi_square):
    """Return *model* with constants at this prior chi-square, and the errors that it has."""
    problem = model.solution.problem
    u = np.zeros(model.solution.u.size)
    u[0] = np.sqrt(chi_square) * problem.prior[0]
    return replace(model, solution=replace(model.solution, u=u))


def test_the_strain_counts_where_the_constants_end_as_expected(setting, retuned):
    """A specimen that is no such muscle at all stays one, whatever takes over a part of it."""
    limit = CRITERIA.strain
    far = strained(retuned, 10.0 * limit)
    for left, does in ((0.9 * limit, True), (5.0 * limit, False)):
        assert is_significant(strained(retuned, left), far, retuned, setting) == does
    near = strained(retuned, 1.5 * limit)
    assert not is_significant(strained(retuned, 0.9 * limit), near, retuned, setting)


@dataclass(frozen=True)
class Judged:
    """A model as decisions see it."""

    effects: tuple
    score: float
    errors: Errors
    strain: float = 0.0


def judged(effects, score, fit, choose):
    return Judged(effects, score, Errors(fit, choose, choose))


def test_a_further_effect_counts_by_what_it_lowers_of_the_score_or_of_the_error(setting):
    """With the noise out of the way: errors are some thousand noise floors."""
    unit = 1e3 * setting.noise
    retuned = judged((), 0.0, 100.0 * unit, 100.0 * unit)
    before = judged(('creep',), -4000.0, 6.0 * unit, 6.0 * unit)
    for score, fit, choose, does in (
        (-4500.0, 5.5, 5.5, False),
        (-4599.0, 5.5, 5.5, False),
        (-4601.0, 5.5, 5.5, True),  # 15 % of 4000
        (-4100.0, 2.5, 2.5, False),
        (-4100.0, 2.3, 2.5, False),
        (-4100.0, 2.3, 2.3, True),  # 60 % of what was left
        (-4700.0, 0.5, 104.0, True),
        (-4700.0, 0.5, 106.0, False),  # than re-tuning alone carries on
    ):
        now = judged(('creep', 'slack'), score, fit * unit, choose * unit)
        assert is_significant(now, before, retuned, setting) == does, (score, fit, choose)


def test_a_free_run_may_lose_in_one_part_what_it_gains_in_the_other(setting):
    before = judged(('hysteresis',), 0.0, 6.7, 8.5)
    for fit, choose, does in ((3.6, 9.3, True), (6.7, 9.0, False), (5.0, 12.0, False)):
        assert is_no_worse(judged((), 0.0, fit, choose), before, setting) == does


def test_a_larger_model_must_lower_the_score_by_the_margin_and_a_smaller_one_may_raise_it_by_it(
    setting,
):
    margin = CRITERIA.margin
    small = judged((), 0.0, 2.0, 2.0)
    for score, error, is_larger_better, is_smaller_enough in (
        (-margin - 0.1, 2.0, True, False),
        (-margin - 0.1, 2.1, False, False),  # its free run is worse, but its score is much lower
        (-margin + 0.1, 2.0, False, True),
        (-margin + 0.1, 1.9, False, False),  # the smaller one has the worse free run
    ):
        large = judged(('creep',), score, error, error)
        assert is_accepted(large, small, setting) == is_larger_better, (score, error)
        assert is_sufficient(small, large, setting) == is_smaller_enough, (score, error)
