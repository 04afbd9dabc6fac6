# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Admission: what counts as an effect, and which of several that explain the same."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import EFFECTS
from pam_ros.identification import evidence
from pam_ros.identification.admission import (
    AS_GOOD,
    Tried,
    admitted,
    could_matter,
    explains_as_much,
    plainest,
    strain,
)
from pam_ros.identification.data.noise import Noise
from pam_ros.identification.evidence import Evidence
from support.equations import least_squares_fit, missing, unknown

KNOWN = {e.name: e for e in EFFECTS}
CLEAR = Evidence(p=1e-9, gain=0.5, interval_clear=True, absorbed=False)
SHAPE = np.sin(np.arange(2000) / 7.0)
NOISE = Noise(0.01, 0.0)


def fit_of(size, *effects):
    """Return a fit that leaves an error of about *size* times 0.7."""
    return missing(SHAPE, size, effects)


def tried(size, known=CLEAR, parents=()):
    return Tried(KNOWN['creep'], parents, fit_of(size, *parents, 'creep'), known, 0.0)


@pytest.mark.parametrize(
    ('changes', 'counts'),
    [
        ({}, True),
        ({'interval_clear': False}, False),
        ({'p': 1.01 * evidence.SIGNIFICANCE}, False),
        ({'gain': 0.99 * evidence.GAIN}, False),
        ({'gain': 0.0, 'absorbed': True}, True),
        ({'gain': 0.0, 'absorbed': True, 'p': 0.5}, False),
    ],
)
def test_a_first_effect_must_pass_every_test(changes, counts):
    one = tried(0.5, replace(CLEAR, **changes))
    assert admitted(one, fit_of(1.0), fit_of(1.0), NOISE) is counts


@pytest.mark.parametrize(
    ('left', 'counts'),
    [(0.1, True), (0.19, False), (0.98 * 0.2 * (1 - evidence.LATER_GAIN), True)],
)
def test_a_further_effect_must_explain_a_share_of_what_was_left(left, counts):
    # Re-tuning left 10, the first effect 0.2 of it: its own form may be that much off.
    parent = fit_of(0.2, 'leak')
    one = tried(left, CLEAR, ('leak',))
    assert admitted(one, parent, fit_of(10.0), NOISE) is counts


def test_a_third_effect_must_explain_more_than_a_second_one():
    # 0.033 of what re-tuning left would do for a second, and 0.51 of the rest.
    for left, beside, counts in ((2.17, 1, True), (2.17, 2, False), (1.07, 2, False)):
        parents = ('leak', 'payload')[:beside]
        one = tried(left, CLEAR, parents)
        assert admitted(one, fit_of(2.5, *parents), fit_of(10.0), NOISE) is counts or left < 2.0
    parents = ('leak', 'payload')
    small = fit_of(0.2, *parents)
    gain = 1.0 - (1.0 - evidence.LATER_GAIN) ** 2
    for left, counts in ((0.98 * 0.2 * (1.0 - gain), True), (1.05 * 0.2 * (1.0 - gain), False)):
        assert admitted(tried(left, CLEAR, parents), small, fit_of(10.0), NOISE) is counts


def rival(name, size, count, gain=0.9):
    """Return a candidate that leaves *size* and took *count* parameters for it."""
    fit = fit_of(size, name)
    solution = replace(fit.solution, u=np.zeros(count))
    known = replace(CLEAR, gain=gain)
    return Tried(KNOWN[name], (), replace(fit, solution=solution), known, 0.0)


@pytest.mark.parametrize(
    ('rivals', 'first'),
    [
        ([('creep', 1.0, 4), ('viscous_friction', 1.01, 1)], 'viscous_friction'),
        ([('creep', 1.0, 4), ('viscous_friction', 1.1, 1)], 'creep'),
        # As its rate vanishes, a leak is a lag: of equals the lag is the plainer.
        ([('leak', 1.0, 2), ('pressure_lag', 1.01, 2)], 'pressure_lag'),
        ([('leak', 1.0, 2), ('pressure_lag', 1.01, 4)], 'pressure_lag'),
        ([('leak', 1.0, 2), ('creep', 1.01, 2)], 'leak'),
    ],
)
def test_of_those_that_explain_as_much_the_plainest_comes_first(rivals, first):
    assert plainest([rival(*r) for r in rivals]).effect.name == first


def test_explaining_as_much_is_measured_against_what_was_there_to_explain():
    strong, weak = rival('creep', 1.0, 3), rival('creep', 1.0, 3, gain=0.05)
    other = rival('leak', 1.0 + 0.9 * AS_GOOD, 3)
    assert explains_as_much(other, strong)
    # The best lowers the error by a twentieth only: what the other leaves of it is a lot.
    assert not explains_as_much(other, weak)


def test_near_the_noise_only_odd_parameters_ask_for_more():
    retuned = fit_of(1.0)
    quiet = Noise(fit_of(0.1, 'creep').held_error, 0.0)
    near, far = fit_of(0.1, 'creep'), fit_of(0.2, 'creep')
    assert not could_matter(near, retuned, quiet)
    assert could_matter(far, retuned, quiet)
    odd = replace(near.solution.problem, unknowns=(unknown('a1', 0.0, 1.0, prior=0.01),))
    assert could_matter(
        replace(near, solution=replace(near.solution, problem=odd)), retuned, quiet
    )


def test_strain_is_that_of_the_declared_parameters_alone():
    columns = np.eye(3)
    unknowns = [
        unknown('a1', 0.0, 1.0, prior=0.5),
        unknown('x', 0.0, 1.0),
        unknown('y0[0]', 0.0, 1.0, prior=0.1, run=0),
    ]
    fit = least_squares_fit(columns, np.array([1.5, 7.0, 2.0]), unknowns, 3.0)
    assert strain(fit) == pytest.approx(9.0)


@pytest.mark.parametrize(
    ('name', 'counts'), [('payload', False), ('creep', True), ('periodic_disturbance', True)]
)
def test_a_payload_that_needs_odd_parameters_does_not_count(name, counts):
    prior = (unknown('a1', 0.0, 1.0, prior=1.0),)
    parent, fit = fit_of(1.0, 'leak'), fit_of(0.1, 'leak', name)
    odd = replace(fit.solution, u=np.array([4.0]))
    odd = replace(odd, problem=replace(odd.problem, unknowns=prior))
    one = Tried(KNOWN[name], ('leak',), replace(fit, solution=odd), CLEAR, 0.0)
    assert strain(one.fit) - strain(parent) > 12.0
    assert admitted(one, parent, fit_of(10.0), NOISE) is counts
    assert admitted(replace(one, fit=fit), parent, fit_of(10.0), NOISE)
