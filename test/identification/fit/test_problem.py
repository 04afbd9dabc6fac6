# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Free runs, starts and memories against closed forms; derivatives against scipy's differences."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import approx_fprime

from pam_ros.effects import EFFECTS, Creep, PressureLag
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.fit.discrepancy import Discrepancy
from pam_ros.identification.fit.places import places_of
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.run_levels import LEVEL, level_unknowns
from pam_ros.identification.fit.unknowns import (
    SPECIMEN,
    MemoryStart,
    memory_unknowns,
    nominal_unknowns,
    proper,
    run_unknowns,
    time_unknowns,
)
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig import layout as at
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.loads import Mass
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import single_muscle_joint
from support.equations import unknown
from support.searches import on_rail

MUSCLE = single_muscle_joint(Muscle(), Mass(mass=20.0))
# A force source of 0.01 N/Pa moves 5 kg on a rail: its motion is a parabola.
GAIN, MASS = 0.01, 5.0
SOURCE = on_rail(GAIN)
PRESSURE = 100.0  # Pa: 0.2 m/s^2
PLACES = places_of(MUSCLE)


def problem_of(model, segments, remembered=()):
    """Return the problem of a model's constants, of starts, and of memories of these effects."""
    memories = [k for name in remembered for k in memory_unknowns(
        model.layout, places_of(model)[name], len(segments)
    )]  # fmt: skip
    unknowns = (*nominal_unknowns(model), *run_unknowns(segments, np.inf), *memories)
    return Problem(
        tuple(segments),
        model.layout,
        model.active,
        model.parameters().ravel(),
        tuple(map(proper, unknowns)),
    )


def parabola(y0, v0, seconds=2.0):
    """Return the segment of a load that starts at y0, v0 under constant pressure."""
    t = 3.0 + np.arange(round(100 * seconds)) / 100.0
    y = y0 + v0 * (t - 3.0) + 0.5 * GAIN * PRESSURE / MASS * (t - 3.0) ** 2
    command = np.full(2, PRESSURE)
    recording = Recording('p', t, t[[0, -1]], command, y)
    return segments_of([recording])[0]


def held(kappa, seed):
    """Return the segment of a muscle at a constant length, its target 300 N throughout."""
    t = np.arange(100) / 50.0
    p = np.random.default_rng(seed).uniform(1e5, 5e5, t.size)
    y = np.full(t.size, kappa * 0.4)
    recording = Recording('h', t, None, None, y, None, np.full(t.size, 300.0), p, 'held')
    return segments_of([recording])[0]


@pytest.fixture
def two_runs():
    """Return the problem of two parabolas, of 2 s and 1 s."""
    return problem_of(SOURCE, [parabola(0.1, -0.05), parabola(0.3, 0.2, 1.0)])


def test_a_run_is_the_parabola_of_a_constant_force(two_runs):
    names = [unknown.name for unknown in two_runs.unknowns]
    assert names == ['a5', 'y0[0]', 'v0[0]', 'y0[1]', 'v0[1]']
    u = np.zeros(5)
    for simulated, s in zip(two_runs.predict(u), two_runs.segments, strict=True):
        np.testing.assert_allclose(simulated, s.target, atol=1e-9)
    np.testing.assert_allclose(two_runs.residuals(u), 0.0, atol=1e-9)
    # A different start and gain: y is linear in all three.
    u = np.array([2.0, 1.0, -3.0, 0.0, 0.0])
    s = two_runs.segments[0]
    since = s.t - s.t[0]
    moved = 1e-3 - 3e-2 * since + SPECIMEN * GAIN * PRESSURE / MASS * since**2
    np.testing.assert_allclose(two_runs.predict(u, 0)[0] - s.target, moved, atol=1e-9)


def test_residuals_are_those_of_the_runs_one_after_the_other(two_runs):
    u = np.array([0.0, 1.0, 0.0, 2.0, 0.0])
    r = two_runs.residuals(u)
    np.testing.assert_allclose(r, np.repeat([1e-3, 2e-3], [200, 100]))
    assert [part.size for part in two_runs.by_run(r)] == [200, 100]
    assert [t.size for t in two_runs.stamps()] == [200, 100]


def test_jacobian_of_parabolas_in_closed_form(two_runs):
    u = np.array([0.3, 0.2, -0.1, 0.4, 0.0])
    found = two_runs.jacobian(u, two_runs.residuals(u))
    since = [s.t - s.t[0] for s in two_runs.segments]
    none = [np.zeros_like(x) for x in since]
    by_gain = np.concatenate([0.5 * SPECIMEN * GAIN * PRESSURE / MASS * x**2 for x in since])
    expected = np.stack(
        [
            by_gain,
            np.concatenate([1e-3 + 0.0 * since[0], none[1]]),
            np.concatenate([1e-2 * since[0], none[1]]),
            np.concatenate([none[0], 1e-3 + 0.0 * since[1]]),
            np.concatenate([none[0], 1e-2 * since[1]]),
        ],
        axis=1,
    )
    np.testing.assert_allclose(found, expected, atol=1e-8)


def test_each_run_has_the_slopes_of_the_unknowns_that_act_in_it(two_runs):
    u = np.array([0.3, 0.2, -0.1, 0.4, 0.0])
    jacobian = two_runs.jacobian(u, two_runs.residuals(u))
    slopes = two_runs.slopes(jacobian)
    assert [own.tolist() for own in slopes.columns] == [[0, 1, 2], [0, 3, 4]]
    assert [block.shape for block in slopes.blocks] == [(200, 3), (100, 3)]
    np.testing.assert_array_equal(slopes.dense, jacobian)


def test_jacobian_of_the_force_law_in_closed_form():
    problem = problem_of(MUSCLE, [held(0.05, 1), held(0.15, 2)])
    u = np.zeros(len(problem.unknowns))
    p = np.concatenate([s.pressure for s in problem.segments])
    kappa = np.concatenate([s.position / 0.4 for s in problem.segments])
    a1, a2, a3, a4, a5, a6 = MUSCLE.muscle.si
    e = np.exp(a3 * kappa)
    force = (a1 * p + a2) * e + a4 * kappa * p + a5 * p + a6
    np.testing.assert_allclose(problem.residuals(u), force - 300.0, rtol=1e-12)
    derivatives = [p * e, e, (a1 * p + a2) * kappa * e, kappa * p, p, np.ones_like(p), 0.0 * p]
    found = problem.jacobian(u, problem.residuals(u))
    for k, (one, derivative) in enumerate(zip(problem.unknowns, derivatives, strict=True)):
        scale = 0.0 if one.name == 'zeta' else one.scale
        np.testing.assert_allclose(found[:, k], scale * derivative, rtol=2e-3, atol=1e-6)


def lagging(tau):
    """Return a force source whose pressure lags by *tau* s."""
    return on_rail(GAIN, [PressureLag(fill=tau, vent=tau)])


@pytest.mark.parametrize('away', [0.5, -1.0])
def test_a_pressure_that_begins_away_from_rest_decays_with_its_lag(away):
    """M y'' = gain (p + d exp(-t/tau)) in closed form, d the distance from the commanded p."""
    tau = 0.3
    problem = problem_of(lagging(tau), [parabola(0.1, 0.0), parabola(0.1, 0.0)], ['pressure_lag'])
    names = [one.name for one in problem.unknowns[-2:]]
    assert names == ['pressure_lag: pressure[0]', 'pressure_lag: pressure[1]']
    u = np.zeros(len(problem.unknowns))
    u[-1] = away
    d = away * problem.unknowns[-1].scale
    first, second = problem.runs(u)
    s = problem.segments[1]
    since = s.t - s.t[0]
    np.testing.assert_allclose(first[:, at.RUN_S], s.target, atol=1e-9)
    np.testing.assert_allclose(second[:, at.RUN_P], PRESSURE + d * np.exp(-since / tau), rtol=1e-9)
    moved = GAIN * d / MASS * tau**2 * (since / tau - 1.0 + np.exp(-since / tau))
    np.testing.assert_allclose(second[:, at.RUN_S] - s.target, moved, rtol=2e-3, atol=1e-7)


# Others have a parameter for what they remember at the start.
REMEMBERING = [
    effect
    for effect in EFFECTS
    if any(s.spread for s in effect.states)
    and 'initial' not in [p.name for p in effect.parameters()]
]


@pytest.mark.parametrize('effect', REMEMBERING, ids=lambda effect: effect.name)
def test_a_memory_begins_where_a_simulation_with_this_start_begins(effect):
    name = effect.name
    model = single_muscle_joint(Muscle(), Mass(mass=20.0), [effect.example()])
    t = np.arange(60) / 50.0
    command = 3e5 + 5e4 * np.sin(6.0 * t)
    y = np.full(t.size, equilibrium(model, command[0]))
    recording = Recording('m', t, t, command, y)
    problem = problem_of(model, segments_of([recording]), [name])
    memories = [k for k, one in enumerate(problem.unknowns) if isinstance(one.of, MemoryStart)]
    assert len(memories) == sum(state.spread > 0.0 for state in effect.states)
    for k in memories:
        u = np.zeros(len(problem.unknowns))
        u[k] = 0.4
        memory = problem.unknowns[k]
        hidden = {name: {memory.of.state: 0.4 * memory.scale}}
        expected = simulate(model, t, command, position=y[0], hidden=hidden).position
        np.testing.assert_allclose(problem.predict(u)[0], expected, atol=1e-9)


@pytest.mark.parametrize('early', [0.8e-3, -0.4e-3])
def test_commands_that_act_early_move_the_load_early(early):
    """The run of commands whose stamps are corrected, and the slope by its unknown."""
    t = np.arange(300) / 200.0
    command_t = np.arange(0.0, 1.5, 0.25)
    command = 3e5 + 4e4 * np.sin(9.0 * command_t)
    y = np.full(t.size, equilibrium(MUSCLE, command[0]))
    recording = Recording('e', t, command_t, command, y)
    (s,) = segments_of([replace(recording, command_spread=1e-3)])
    without = problem_of(MUSCLE, [s])
    problem = replace(without, unknowns=(*without.unknowns, *time_unknowns([s])))
    u = np.zeros(len(problem.unknowns))
    u[-1] = early / 1e-3
    (found,) = problem.predict(u)
    expected = simulate(MUSCLE, t, command, command_t - early, position=y[0]).position
    (late,) = without.predict(u[:-1])
    assert np.max(np.abs(found - expected)) < 1e-2 * np.max(np.abs(late - expected))
    slope = problem.jacobian(u, problem.residuals(u))[:, -1]
    np.testing.assert_allclose(slope * u[-1], found - late, atol=1e-12)
    (same,) = segments_of([recording])
    (kept,) = replace(problem, segments=(same,)).predict(u)
    np.testing.assert_array_equal(kept, late)  # its commands were stamped by the clock of the rest


def test_a_level_lifts_the_force_of_its_run_alone():
    segments = [held(kappa, seed) for seed, kappa in enumerate((0.1, 0.1, 0.1))]
    segments = [replace(s, target=s.target + np.arange(s.t.size)) for s in segments]
    levels = level_unknowns(segments, MUSCLE)
    problem = problem_of(MUSCLE, segments)
    whole = replace(problem, unknowns=(*problem.unknowns, *levels))
    u = np.zeros(len(problem.unknowns))
    force = problem.predict(u)
    lifted = whole.predict(np.array([*u, 1.0, -2.0]))
    scale = levels[0].scale
    assert scale == pytest.approx(LEVEL * 99.0)
    for run, lift in enumerate((scale, -2.0 * scale, 0.0)):
        np.testing.assert_allclose(lifted[run], force[run] + lift)
        (alone,) = whole.predict(np.array([*u, 1.0, -2.0]), run)
        np.testing.assert_array_equal(alone, lifted[run])
    place = np.array([*u, 0.3, 0.4])
    jacobian = whole.jacobian(place, whole.residuals(place))[:, -2:]
    expected = scale * np.kron(np.eye(3), np.ones((100, 1)))[:, :2]
    np.testing.assert_allclose(jacobian, expected, atol=1e-8)
    # Runs themselves are those of the muscle.
    np.testing.assert_array_equal(whole.runs(place)[0], problem.runs(u)[0])


def test_a_state_that_is_always_known_is_no_unknown():
    found = memory_unknowns(MUSCLE.layout, PLACES['creep'], 2)
    assert [k.of.state for k in found[:6]] == [
        f'{which} {of}'
        for of in ('force', 'contraction', 'pressure')
        for which in ('fast', 'slow')
    ]
    assert [k.of.run for k in found] == 6 * [0] + 6 * [1]
    assert memory_unknowns(MUSCLE.layout, PLACES['dead_time'], 2) == []


@pytest.mark.needs_numba
def test_jacobian_of_a_swinging_muscle_against_scipy():
    model = single_muscle_joint(
        Muscle(), Mass(mass=20.0), [Creep(stiffness=500.0, pressure=0.02, time=0.7)]
    )
    t = np.arange(400) / 100.0
    command = 3e5 + 5e4 * np.sin(2 * np.pi * 1.3 * t)
    y = np.full(t.size, equilibrium(MUSCLE, 3e5))
    recording = Recording('m', t, t, command, y)
    problem = problem_of(model, segments_of([recording]), ['creep'])
    u = np.random.default_rng(3).uniform(-0.5, 0.5, len(problem.unknowns))
    found = problem.jacobian(u, problem.residuals(u))
    central = sum(approx_fprime(u, problem.residuals, h) for h in (1e-5, -1e-5)) / 2.0
    sizes = np.linalg.norm(central, axis=0)
    assert np.all(sizes[: len(sizes) - 6] > 0.0)
    np.testing.assert_array_less(np.linalg.norm(found - central, axis=0), 0.01 * sizes + 1e-9)


def test_columns_come_alone_and_side_by_side(two_runs):
    u = np.full(5, 0.1)
    r = two_runs.residuals(u)
    whole = two_runs.jacobian(u, r)
    np.testing.assert_array_equal(two_runs.jacobian(u, r, only=[3, 0]), whole[:, [3, 0]])
    assert two_runs.jacobian(u, r, only=[]).shape == (r.size, 0)
    with ThreadPoolExecutor(2) as pool:
        np.testing.assert_array_equal(two_runs.jacobian(u, r, pool), whole)


def test_the_row_contains_the_unknowns_and_nothing_else_changes(two_runs):
    row = two_runs.row_at(np.array([1.0, 5.0, 5.0, 5.0, 5.0]))
    a5 = SOURCE.layout.constant(at.A5)
    assert row[a5] == pytest.approx((1.0 + SPECIMEN) * GAIN)
    others = np.arange(row.size) != a5
    np.testing.assert_array_equal(row[others], two_runs.row[others])
    assert two_runs.row[a5] == GAIN


def test_a_run_that_diverges_leaves_finite_residuals(two_runs):
    wild = replace(two_runs, row=two_runs.row.copy())
    wild.row[SOURCE.layout.constant(at.A6)] = 1e300
    with np.errstate(all='ignore'):  # without numba, numpy says what overflows
        r = wild.residuals(np.zeros(5))
    assert np.all(np.isfinite(r))
    assert np.max(np.abs(r)) > 1e3


def test_what_is_not_to_be_fitted_is_simulated_and_counts_for_nothing(two_runs):
    """Columns, stamps and whitening know the samples alone that the runs mark."""
    u = 0.3 * np.ones(len(two_runs.unknowns))
    marks = [
        np.random.default_rng(k).random(s.t.size) < 0.4 for k, s in enumerate(two_runs.segments)
    ]
    runs = [replace(s, fit=mark) for s, mark in zip(two_runs.segments, marks, strict=True)]
    marked, keep = replace(two_runs, segments=tuple(runs)), np.concatenate(marks)
    r = two_runs.residuals(u)
    np.testing.assert_array_equal(marked.residuals(u), r[keep])
    jacobian = two_runs.jacobian(u, r)[keep]
    np.testing.assert_array_equal(marked.jacobian(u, r[keep]), jacobian)
    assert [p.size for p in marked.predict(u)] == [s.t.size for s in two_runs.segments]
    process = Discrepancy(3.0, 0.4)
    found = marked.whitened(jacobian, marked.whitenings(process))
    parts = np.split(jacobian, [int(marks[0].sum())])
    expected = [
        process.whitening(s.t[mark])(part)
        for s, mark, part in zip(two_runs.segments, marks, parts, strict=True)
    ]
    np.testing.assert_array_equal(found, np.concatenate(expected))


def test_an_infinite_prior_becomes_a_wide_one():
    strength, time = unknown('x'), unknown('t', 1.0, logarithmic=True)
    assert proper(strength).prior == 3.0
    assert proper(time).prior == 1.5
    known = unknown('y', prior=0.3)
    assert proper(known) is known
