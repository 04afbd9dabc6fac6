# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The moment of a fit: found from afar; its interval where the cost is smooth and where not."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.fit.extend import with_effect
from pam_ros.identification.fit.intervals import half_widths
from pam_ros.identification.fit.onset import index_of_onset, interval, refine_onset
from pam_ros.identification.fit.places import places_of
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.solve import initial_solution, least_squares
from pam_ros.identification.fit.unknowns import onset_unknown
from pam_ros.recording.recording import Recording
from support import bench_truth

NOISE = 20e-6
HOLD = 1.0  # s, of every command
JOINT = bench_truth.nominal()
PLACES = places_of(JOINT)


def problem_of(effect, start, near, true, seed=0):
    """Return the problem of an effect that begins at *true* s, looked for *near*, and its u.

    Commands are held for a second each. What was measured is the model's own run with white
    noise: the fit is tested here, and not the physics.
    """
    t = np.arange(1000) / 100.0
    stamps = np.arange(0.0, 10.0, HOLD)
    rng = np.random.default_rng(seed)
    command = rng.uniform(2.5e5, 4.5e5, stamps.size)
    blank = Recording('p', t, stamps, command, np.zeros(t.size), None, None, None, 'free')
    (segment,) = segments_of([blank])
    row, layout = JOINT.parameters().ravel(), JOINT.layout

    def problem(segment, moment):
        plain = Problem((segment,), layout, JOINT.active, row, (onset_unknown([segment], moment),))
        found, u = with_effect(plain, JOINT, PLACES[effect], start)
        return found, np.concatenate([[0.0], u])

    whole, u = problem(segment, true)
    measured = whole.predict(u)[0] + NOISE * rng.standard_normal(t.size)
    return problem(replace(segment, target=measured), near)


def moment_of(known):
    """Return the moment in s of a solution."""
    k = index_of_onset(known)
    return known.problem.unknowns[k].value(known.u[k])


@pytest.mark.parametrize('near', [5.9, 5.1])
def test_a_lag_that_begins_in_a_hold_is_found_in_another(near):
    """From an adjacent hold no slope leads to the moment: it is 0, or points to the hold's end."""
    problem, u = problem_of('pressure_lag', {'fill': 0.1, 'vent': 0.1}, near, 4.6)
    known = initial_solution(problem, u)
    better = refine_onset(known)
    assert 4.0 <= moment_of(better) <= 5.0  # a command of the same stamp acts after it
    assert better.cost < known.cost
    assert refine_onset(better).cost == better.cost


def test_without_a_moment_nothing_moves():
    problem, u = problem_of('payload', {'mass': 2.0}, 5.0, 5.0)
    plain = initial_solution(replace(problem, unknowns=problem.unknowns[1:]), u[1:])
    assert index_of_onset(plain) is None
    assert refine_onset(plain) is plain


def test_all_moments_of_a_hold_are_in_the_interval():
    problem, u = problem_of('pressure_lag', {'fill': 0.1, 'vent': 0.1}, 4.6, 4.6)
    value, low, high = interval(least_squares(initial_solution(problem, u)))
    assert value == pytest.approx(4.6)
    assert low == pytest.approx(4.0, abs=5e-3)
    assert high == pytest.approx(5.0, abs=5e-3)


def test_where_the_cost_is_smooth_the_interval_is_that_of_the_jacobian():
    """The payload comes together with what it does to the load: its mass is unknown, too."""
    problem, u = problem_of('payload', {'mass': 2.0}, 5.05, 5.03)
    known = least_squares(initial_solution(problem, u))
    value, low, high = interval(known)
    half = half_widths(known, known.most_likely())[0]
    assert abs(value - 5.03) < 2.0 * half
    assert low == pytest.approx(value - half, abs=0.05 * half)
    assert high == pytest.approx(value + half, abs=0.05 * half)


@pytest.mark.slow
@pytest.mark.needs_numba
def test_intervals_hold_the_truth():
    inside = []
    for seed in range(40):
        problem, u = problem_of('viscous_friction', {'coefficient': 80.0}, 5.05, 5.03, seed)
        _, low, high = interval(least_squares(initial_solution(problem, u)))
        inside.append(low <= 5.03 <= high)
    # 95 % of 40: 34 are three standard deviations below.
    assert sum(inside) >= 34
