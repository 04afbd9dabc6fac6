# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Residuals and their derivatives, against closed forms and scipy's differences."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import approx_fprime
from scipy.special import pseudo_huber

from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.fit.unknowns import SPECIMEN, declared_unknowns, run_unknowns
from pam_ros.identification.problem import Problem
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig import layout as at
from pam_ros.rig.joint import one_muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.rest import rest
from support.equations import equation, unknown

MUSCLE = one_muscle(Muscle(), Mass(mass=20.0))
# A force source of 0.01 N/Pa moves 5 kg on a rail: its motion is a parabola.
GAIN, MASS = 0.01, 5.0
SOURCE = one_muscle(
    Muscle(a1=0.0, a2=0.0, a3=0.0, a4=0.0, a5=GAIN, a6=0.0, zeta=0.0, pressure_unit='Pa',
           contraction_unit='fraction', l0=1.0),
    Mass(mass=MASS, mount='horizontal'),
)  # fmt: skip
PRESSURE = 100.0  # Pa: 0.2 m/s^2


def problem_of(model, segments, outlier=np.inf):
    unknowns = (*declared_unknowns(model), *run_unknowns(segments, np.inf))
    samples = float(sum(s.fit.sum() for s in segments))
    return Problem(
        tuple(segments),
        model.layout,
        model.active,
        model.parameters().ravel(),
        unknowns,
        samples,
        1e-3,
        outlier,
    )


def parabola(y0, v0, seconds=2.0):
    """Return the segment of a load that starts at y0, v0 under constant pressure."""
    t = 3.0 + np.arange(round(100 * seconds)) / 100.0
    y = y0 + v0 * (t - 3.0) + 0.5 * GAIN * PRESSURE / MASS * (t - 3.0) ** 2
    command = np.full(2, PRESSURE)
    recording = Recording('p', t, t[[0, -1]], command, y, None, None, None, 'free')
    return segments_of([recording], keep_back=True)[0]


def held(kappa, seed):
    """Return the segment of a muscle at a constant length, its target 300 N throughout."""
    t = np.arange(100) / 50.0
    p = np.random.default_rng(seed).uniform(1e5, 5e5, t.size)
    y = np.full(t.size, kappa * 0.4)
    recording = Recording('h', t, None, None, y, None, np.full(t.size, 300.0), p, 'held')
    return segments_of([recording], keep_back=True)[0]


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


def test_a_run_counts_by_its_weight(two_runs):
    u = np.array([2.0, 1.0, -3.0, 0.5, 0.2])
    weighted = replace(two_runs, weights=(0.5, 3.0))
    times = np.repeat([0.5, 3.0], [rows.size for rows in two_runs.fit_rows])
    r = two_runs.residuals(u)
    np.testing.assert_allclose(weighted.residuals(u), times * r, rtol=1e-12)
    # The columns of a run's own start, too.
    np.testing.assert_allclose(
        weighted.jacobian(u, times * r), times[:, None] * two_runs.jacobian(u, r), rtol=1e-9
    )
    assert weighted.errors(u) == two_runs.errors(u)


def test_jacobian_of_parabolas_in_closed_form(two_runs):
    u = np.array([0.3, 0.2, -0.1, 0.4, 0.0])
    found = two_runs.jacobian(u, two_runs.residuals(u))
    since = [(s.t - s.t[0])[s.fit] for s in two_runs.segments]
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


def test_jacobian_of_the_force_law_in_closed_form():
    segments = [held(0.05, 1), held(0.15, 2)]
    problem = problem_of(MUSCLE, segments)
    u = np.zeros(len(problem.unknowns))
    p = np.concatenate([s.pressure[s.fit] for s in segments])
    kappa = np.concatenate([s.position[s.fit] / 0.4 for s in segments])
    a1, a2, a3, a4, a5, a6 = MUSCLE.muscle.si
    e = np.exp(a3 * kappa)
    force = (a1 * p + a2) * e + a4 * kappa * p + a5 * p + a6
    np.testing.assert_allclose(problem.residuals(u), force - 300.0, rtol=1e-12)
    derivatives = [p * e, e, (a1 * p + a2) * kappa * e, kappa * p, p, np.ones_like(p), 0.0 * p]
    found = problem.jacobian(u, problem.residuals(u))
    for k, (one, derivative) in enumerate(zip(problem.unknowns, derivatives, strict=True)):
        scale = 0.0 if one.name == 'zeta' else one.scale
        np.testing.assert_allclose(found[:, k], scale * derivative, rtol=2e-3, atol=1e-6)


@pytest.mark.needs_numba
def test_jacobian_of_a_swinging_muscle_against_scipy():
    t = np.arange(400) / 100.0
    command = 3e5 + 5e4 * np.sin(2 * np.pi * 1.3 * t)
    y = np.full(t.size, rest(MUSCLE, 3e5))
    recording = Recording('m', t, t, command, y, None, None, None, 'free')
    problem = problem_of(MUSCLE, segments_of([recording], keep_back=True), outlier=5e-4)
    u = np.random.default_rng(3).uniform(-0.5, 0.5, len(problem.unknowns))
    found = problem.jacobian(u, problem.residuals(u))
    central = sum(approx_fprime(u, problem.residuals, h) for h in (1e-5, -1e-5)) / 2.0
    sizes = np.linalg.norm(central, axis=0)
    np.testing.assert_array_less(np.linalg.norm(found - central, axis=0), 0.01 * sizes)


def test_columns_come_alone_and_side_by_side(two_runs):
    u = np.full(5, 0.1)
    r = two_runs.residuals(u)
    whole = two_runs.jacobian(u, r)
    np.testing.assert_array_equal(two_runs.jacobian(u, r, only=[3, 0]), whole[:, [3, 0]])
    with ThreadPoolExecutor(2) as pool:
        np.testing.assert_array_equal(two_runs.jacobian(u, r, pool), whole)


def test_a_column_never_leaves_its_bounds():
    seen = []

    def function(u):
        seen.append(u[0])
        return np.array([u[0] ** 2, 1.0])

    problem = equation(function, [unknown('x', 0.0, 1.0, -1.0, 2.0)], 2.0)
    for u in (-1.0, 2.0, 2.0 - 1e-4, 0.5):
        at_u = np.array([u])
        slope = problem.jacobian(at_u, problem.residuals(at_u))[0, 0]
        assert slope == pytest.approx(2.0 * u, abs=2e-3)
    assert min(seen) >= -1.0
    assert max(seen) <= 2.0


def test_the_row_holds_what_is_unknown_and_nothing_else_moves(two_runs):
    u = np.array([1.0, 5.0, 5.0, 5.0, 5.0])
    row = two_runs.row_at(u)
    a5 = SOURCE.layout.constant(at.A5)
    assert row[a5] == pytest.approx((1.0 + SPECIMEN) * GAIN)
    others = np.arange(row.size) != a5
    np.testing.assert_array_equal(row[others], two_runs.row[others])
    assert two_runs.row[a5] == GAIN


def test_outliers_count_by_pseudo_hubers_loss(two_runs):
    delta = 1e-3
    robust = replace(two_runs, outlier=delta)
    u = np.array([0.0, 0.5, 8.0, -0.2, 0.0])
    e, r = two_runs.residuals(u), robust.residuals(u)
    np.testing.assert_allclose(r**2, 2.0 * pseudo_huber(delta, e), rtol=1e-6, atol=1e-15)
    np.testing.assert_array_equal(np.sign(r), np.sign(e))
    assert np.max(np.abs(e)) > 50.0 * delta  # some are far beyond
    # Derivatives are those of the compressed residuals, start states included.
    found = robust.jacobian(u, r)
    central = sum(approx_fprime(u, robust.residuals, h) for h in (1e-5, -1e-5)) / 2.0
    np.testing.assert_allclose(found, central, atol=2e-3 * np.max(np.abs(central)))


def test_errors_of_what_is_fitted_and_kept_back(two_runs):
    u = np.array([0.0, 1.0, 0.0, 2.0, 0.0])
    fit, kept = two_runs.errors(u)
    sizes = [(s.fit.sum(), (~s.fit).sum()) for s in two_runs.segments]
    for found, (first, second) in ((fit, (0, 0)), (kept, (1, 1))):
        a, b = sizes[0][first], sizes[1][second]
        assert found == pytest.approx(np.sqrt((a * 1e-6 + b * 4e-6) / (a + b)), rel=1e-6)
    whole = replace(
        two_runs, segments=[replace(s, fit=np.ones_like(s.fit)) for s in two_runs.segments]
    )
    assert np.isnan(whole.errors(u)[1])


def test_cost_is_twice_the_negative_log_posterior():
    unknowns = [unknown('x', 0.0, 1.0, prior=0.5), unknown('y', 0.0, 1.0)]
    problem = equation(lambda u: np.array([3.0, 4.0, 0.0]) + 0.0 * u[0], unknowns, 10.0)
    u = np.array([1.0, 7.0])
    np.testing.assert_allclose(problem.priors(u), [2.0, 0.0])
    assert problem.cost(u, problem.residuals(u)) == pytest.approx(10.0 * np.log(25.0 / 3.0) + 4.0)


def test_a_run_that_diverges_leaves_finite_residuals(two_runs):
    wild = replace(two_runs, row=two_runs.row.copy())
    wild.row[SOURCE.layout.constant(at.A6)] = 1e300
    with np.errstate(all='ignore'):  # without numba, numpy says what overflows
        r = wild.residuals(np.zeros(5))
    assert np.all(np.isfinite(r))
    assert np.max(np.abs(r)) > 1e3
