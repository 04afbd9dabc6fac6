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
from pam_ros.identification.fit.unknowns import MemoryStart, onset_unknown
from pam_ros.recording.recording import Recording
from pam_ros.rig import layout as at
from support import bench_truth
from support.searches import on_rail

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
    blank = Recording('p', t, stamps, command, np.zeros(t.size))
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


# Runs in which something begins in the middle, against closed forms on a rail --------------------


# A force source of 0.01 N/Pa moves 5 kg on a rail.
GAIN, MASS = 0.01, 5.0
SOURCE = on_rail(GAIN)
PLACES_ON_RAIL = places_of(SOURCE)
PRESSURE = 100.0  # Pa: 0.2 m/s^2
PUSH = GAIN * PRESSURE / MASS
T = np.arange(200) / 100.0


def late(effect, start, onset, command=(PRESSURE, PRESSURE), gap=None):
    """Return the problem of an effect that begins at *onset*, and its u there.

    Commands are at 0 s and at 1.5 s; *gap* is a time in s at which the run is cut in two.
    """
    stamps = np.array([0.0, 1.5])
    recording = Recording('p', T, stamps, np.array(command), np.zeros(T.size))
    (segment,) = segments_of([recording])
    segments = [replace(segment, y0=0.0, v0=0.0)]
    if gap is not None:
        rows = np.split(np.arange(T.size), [int(np.searchsorted(T, gap))])
        segments = [
            replace(segment, t=T[r], target=segment.target[r], fit=segment.fit[r], y0=0.0, v0=0.0)
            for r in rows
        ]
    plain = Problem(
        tuple(segments),
        SOURCE.layout,
        SOURCE.active,
        SOURCE.parameters().ravel(),
        (onset_unknown(segments, onset),),
    )
    problem, u = with_effect(plain, SOURCE, PLACES_ON_RAIL[effect], start)
    return problem, np.concatenate([[0.0], u])


@pytest.mark.parametrize('onset', [0.7, 0.7041, 1.2])
def test_viscous_friction_from_a_moment_on(onset):
    """Until then a parabola, then the speed approaches that at which friction balances the pull.

    The moment may lie on a sample or between two.
    """
    c = 20.0
    problem, u = late('viscous_friction', {'coefficient': c}, onset)
    (run,) = problem.runs(u)
    since, rate = np.maximum(T - onset, 0.0), c / MASS
    speed, last = PUSH * onset, PUSH / rate
    v = np.where(onset >= T, PUSH * T, last + (speed - last) * np.exp(-rate * since))
    there = 0.5 * PUSH * onset**2
    s = there + last * since + (speed - last) * (1.0 - np.exp(-rate * since)) / rate
    np.testing.assert_allclose(run[:, at.RUN_V], v, atol=1e-9)
    np.testing.assert_allclose(
        run[:, at.RUN_S], np.where(onset >= T, 0.5 * PUSH * T**2, s), atol=1e-9
    )


def test_a_lag_begins_with_the_pressure_that_is_there():
    """It shows when the command changes: until then the chamber keeps what it has."""
    problem, u = late('pressure_lag', {'fill': 0.1, 'vent': 0.1}, 0.7, (PRESSURE, 3 * PRESSURE))
    (run,) = problem.runs(u)
    p = PRESSURE + 2.0 * PRESSURE * -np.expm1(-np.maximum(T - 1.5, 0.0) / 0.1)
    np.testing.assert_allclose(run[:, at.RUN_P], p, rtol=1e-9)


def test_a_leak_begins_with_a_full_chamber():
    """It does not begin in the balance in which a leak that was there before would be."""
    problem, u = late('leak', {'rate': 0.5, 'refill': 0.2}, 0.5)
    (run,) = problem.runs(u)
    pace, rest = 1.0 / 0.2 + 0.5, PRESSURE / (1.0 + 0.5 * 0.2)
    p = rest + (PRESSURE - rest) * np.exp(-pace * np.maximum(T - 0.5, 0.0))
    np.testing.assert_allclose(run[:, at.RUN_P], p, rtol=1e-9)


@pytest.mark.parametrize(('onset', 'acts'), [(0.0, True), (T[-1], False)])
def test_at_the_ends_it_acts_always_or_never(onset, acts):
    problem, u = late('payload', {'mass': 5.0}, onset)
    (run,) = problem.runs(u)
    push = PUSH / 2.0 if acts else PUSH
    np.testing.assert_allclose(run[:, at.RUN_S], 0.5 * push * T**2, atol=1e-9)


def test_what_begins_before_a_gap_is_there_behind_it():
    problem, u = late('payload', {'mass': 5.0}, 0.5, gap=1.0)
    first, second = problem.runs(u)
    np.testing.assert_allclose(np.diff(first[:50, at.RUN_V]), 0.01 * PUSH, rtol=1e-6)
    np.testing.assert_allclose(np.diff(first[51:, at.RUN_V]), 0.005 * PUSH, rtol=1e-6)
    np.testing.assert_allclose(np.diff(second[:, at.RUN_V]), 0.005 * PUSH, rtol=1e-6)


def test_a_run_is_smooth_in_the_moment():
    """The column of the moment is the closed form's derivative, also near a sample."""
    c, onset = 20.0, 0.7
    problem, u = late('viscous_friction', {'coefficient': c}, onset)
    column = problem.jacobian(u, problem.residuals(u))[:, 0]
    since, rate = np.maximum(T - onset, 0.0), c / MASS
    # A speed v at the moment is lost a little later: the friction's impulse moves with it.
    exact = PUSH * onset * -np.expm1(-rate * since)
    np.testing.assert_allclose(column, exact, atol=3e-3 * np.max(exact))


@pytest.mark.parametrize('begins_late', [True, False])
def test_what_begins_later_has_no_memory_at_the_start(begins_late):
    problem, _ = late('payload', {'mass': 1.0}, 0.7)
    plain = replace(problem, unknowns=problem.unknowns[:1] if begins_late else ())
    lag, _ = with_effect(plain, SOURCE, PLACES_ON_RAIL['pressure_lag'], {'fill': 0.1, 'vent': 0.1})
    assert any(isinstance(k.of, MemoryStart) for k in lag.unknowns) is not begins_late
