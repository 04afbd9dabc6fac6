# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where the cheap fits of one more effect begin."""

import numpy as np
import pytest

from pam_ros.identification.fit.discrepancy import WHITE
from pam_ros.identification.fit.unknowns import OF_RETUNING, MemoryStart
from pam_ros.identification.search.starts import extended, guessed, screen

pytestmark = [pytest.mark.slow, pytest.mark.needs_numba]


def of_effect(solution):
    """Return the values of the effect's unknowns, by name."""
    pairs = zip(solution.problem.unknowns, solution.u, strict=True)
    return {one.name: one.value(u) for one, u in pairs if one.name.startswith('effects.')}


def has_nominal_constants(solution):
    unknowns = solution.problem.unknowns
    return not np.any(solution.u[[isinstance(one.of, OF_RETUNING) for one in unknowns]])


def test_at_nominal_constants_only_the_best_starts_are_tried(retuned, setting, monkeypatch):
    assert retuned.solution.discrepancy != WHITE
    place = setting.places['pressure_lag']
    begun = []

    def look(wider, setting):
        begun.append(wider)
        return wider

    monkeypatch.setattr('pam_ros.identification.search.starts._screened', look)
    found = screen(retuned, place, setting)
    with_process = [one for one in begun if one.discrepancy != WHITE]
    white = [one for one in begun if one not in with_process and not has_nominal_constants(one)]
    nominal = [one for one in begun if has_nominal_constants(one)]
    assert len(with_process) == len(white) == len(place.fit_starts)
    best = [of_effect(min(some, key=lambda one: one.cost)) for some in (with_process, white)]
    expected = best[:1] if best[0] == best[1] else best
    assert [of_effect(one) for one in nominal] == expected
    assert {one.discrepancy for one in nominal} == {WHITE}
    assert len(found) == 2 * setting.budget.fits + min(len(nominal), setting.budget.fits)


def test_looks_come_best_first_and_never_worse_than_their_start(retuned, setting):
    place = setting.places['pressure_lag']
    found = screen(retuned, place, setting)
    assert [one.score for one in found] == sorted(one.score for one in found)
    starts = place.effect.fit_starts()
    begun = [extended(retuned.solution, place, start, setting) for start in starts]
    assert found[0].score < min(one.score for one in begun)


def test_columns_of_what_was_there_are_kept_and_hidden_starts_that_move_nothing_left_out(
    retuned, setting
):
    place = setting.places['creep']
    known = extended(retuned.solution, place, {'stiffness': 500.0, 'time': 3.0}, setting)
    count = len(retuned.solution.u)
    np.testing.assert_array_equal(known.jacobian[:, :count], retuned.solution.jacobian)
    memories = [k.of.state for k in known.problem.unknowns if isinstance(k.of, MemoryStart)]
    assert set(memories) == {'fast contraction', 'slow contraction'}


def test_a_frequency_is_read_from_what_is_left(retuned, setting):
    starts = guessed(retuned, setting.places['periodic_disturbance'])
    assert starts
    assert all(start['frequency'] > 0.0 for start in starts)
    assert guessed(retuned, setting.places['dead_time']) == ()
