# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fits against scipy, and covariances against closed forms and repeated noise."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares

from pam_ros.identification.solve import Solution, amplified_cost, improved, predicted_cost, solve
from support.equations import coloured, equation, linear, unknown

T = np.linspace(0.0, 5.0, 400)
TRUTH = np.array([2.0, 0.8, 0.5])
NOISE = 0.05
# A fit ends when a step gains less than a tenth of -2 log likelihood.
CLOSE = 0.2


def decay(u):
    return u[0] * np.exp(-u[1] * T) + u[2]


MEASURED = decay(TRUTH) + NOISE * np.random.default_rng(1).standard_normal(T.size)


def decaying(**changes):
    """Return the problem of a decay; x=(low, high, prior) for x of a, b, c."""
    unknowns = []
    for name in 'abc':
        low, high, prior = changes.get(name, (-np.inf, np.inf, np.inf))
        unknowns.append(unknown(name, 0.0, 1.0, low, high, prior))
    return equation(lambda u: decay(u) - MEASURED, unknowns, float(T.size))


def by_scipy(problem, solution):
    """Return scipy's optimum of the same cost, the noise variance taken from *solution*."""
    weight = np.sqrt(problem.independent / float(solution.r @ solution.r))
    low, high = np.array([k.bounds for k in problem.unknowns]).T

    def stacked(u):
        return np.concatenate([weight * problem.residuals(u), problem.priors(u)])

    start = np.clip(np.ones(3), np.nextafter(low, np.inf), np.nextafter(high, -np.inf))
    return least_squares(stacked, start, bounds=(low, high), xtol=1e-12, ftol=1e-12, gtol=1e-12).x


@pytest.mark.parametrize(
    'changes',
    [
        {},
        {'b': (0.0, 0.6, np.inf)},  # the bound is active
        {'a': (-np.inf, np.inf, 0.02), 'c': (-np.inf, np.inf, 0.01)},  # strong priors at 0
        {'a': (-np.inf, np.inf, 0.05), 'b': (1.0, 4.0, np.inf)},  # both
    ],
    ids=['plain', 'bound', 'priors', 'prior_and_bound'],
)
@pytest.mark.parametrize('start', [(1.0, 1.0, 0.0), (1.0, 1.5, 0.0), (3.0, 0.4, 1.0)])
def test_ends_where_scipy_ends(changes, start):
    problem = decaying(**changes)
    solution = solve(problem, np.array(start), 60)
    expected = by_scipy(problem, solution)
    least = problem.cost(expected, problem.residuals(expected))
    assert solution.cost == pytest.approx(least, abs=CLOSE)
    error = np.sqrt(np.diag(solution.covariance()))
    np.testing.assert_array_less(np.abs(solution.u - expected), 0.5 * error + 1e-12)
    for one, u in zip(problem.unknowns, solution.u, strict=True):
        assert one.bounds[0] <= u <= one.bounds[1]
    np.testing.assert_array_equal(solution.r, problem.residuals(solution.u))


def test_a_value_is_found_by_name():
    solution = solve(decaying(), np.ones(3))
    assert solution.value('b') == solution.u[1]
    with pytest.raises(KeyError):
        solution.value('d')


@settings(max_examples=40)
@given(st.integers(0, 10_000), st.booleans())
def test_never_ends_higher_than_it_began(seed, rugged):
    rng = np.random.default_rng(seed)
    columns, values = rng.standard_normal((30, 4)), rng.standard_normal(30)
    waves = 3.0 * rng.standard_normal((30, 4)) if rugged else np.zeros((30, 4))
    unknowns = [
        unknown(str(k), 0.0, 1.0, -1.0, 1.5, prior) for k, prior in enumerate((1, 9, 0.1, np.inf))
    ]
    problem = equation(lambda u: columns @ u + waves @ np.sin(5.0 * u) - values, unknowns, 12.0)
    start = rng.uniform(-1.0, 1.5, 4)
    stale = rng.standard_normal((30, 4)) if seed % 2 else None
    solution = solve(problem, start, 6, jacobian=stale)
    assert solution.cost <= problem.cost(start, problem.residuals(start)) + 1e-9
    assert np.all((solution.u >= -1.0) & (solution.u <= 1.5))


def test_a_start_outside_its_bounds_is_brought_in():
    problem = decaying(b=(0.5, 1.0, np.inf))
    assert 0.5 <= solve(problem, np.array([1.0, 7.0, 0.0])).u[1] <= 1.0


def test_a_jacobian_kept_up_to_date_leads_to_the_same_optimum():
    problem = decaying(c=(-np.inf, np.inf, 0.3))
    start = np.array([1.0, 1.5, 0.0])
    exact = solve(problem, start, 60)
    elsewhere = np.array([1.3, 1.2, 0.1])
    old = problem.jacobian(elsewhere, problem.residuals(elsewhere))
    for jacobian in (old, old * np.array([1.0, 0.3, 1.5]), np.zeros_like(old) + 0.1):
        kept = solve(problem, start, 60, jacobian=jacobian)
        assert kept.cost == pytest.approx(exact.cost, abs=CLOSE)


def test_a_good_jacobian_spares_computing_others():
    calls = []

    def function(u):
        calls.append(1)
        return decay(u) - MEASURED

    problem = equation(function, ('a', 'b', 'c'), float(T.size))
    near = TRUTH + 0.02
    jacobian = problem.jacobian(near, problem.residuals(near))
    calls.clear()
    with_it = solve(problem, near, jacobian=jacobian)
    few = len(calls)
    calls.clear()
    without = solve(problem, near)
    assert with_it.cost == pytest.approx(without.cost, abs=CLOSE)
    assert few < len(calls)


@pytest.mark.parametrize('start', [(1.0, 1.0, 0.0), (1.0, 1.5, 0.0), (3.0, 0.4, 1.0)])
def test_a_goal_in_reach_is_reached_and_one_that_is_not_given_up(start):
    calls = []

    def function(u):
        calls.append(1)
        return decay(u) - MEASURED

    problem = equation(function, ('a', 'b', 'c'), float(T.size))
    start = np.array(start)
    free = solve(problem, start, 60)
    near = solve(problem, start, 60, goal=free.cost + 0.1)
    np.testing.assert_array_equal(near.u, free.u)
    calls.clear()
    solve(problem, start, 60)
    needed = len(calls)
    calls.clear()
    far = solve(problem, start, 60, goal=free.cost - 1e6)
    assert len(calls) < 0.7 * needed
    assert far.cost >= free.cost


def test_frozen_columns_are_not_computed_and_the_others_are():
    moved = []

    def function(u):
        moved.append(u.copy())
        return decay(u) - MEASURED

    problem = equation(function, ('a', 'b', 'c'), float(T.size))
    start = np.array([2.0, 0.8, 0.0])
    jacobian = problem.jacobian(start, problem.residuals(start))
    moved.clear()
    known = Solution(problem, start, problem.residuals(start), jacobian, 0)
    solution = improved(known, 2, frozen=2)
    assert solution.cost < problem.cost(start, problem.residuals(start))
    steps = [b - a for a in moved for b in moved]
    lone = [np.flatnonzero(step) for step in steps]
    assert not any(k.size == 1 and k[0] < 2 for k in lone)
    assert any(k.size == 1 and k[0] == 2 for k in lone)


def line(values, prior=np.inf, independent=None):
    """Return the problem of a straight line through *values* over T."""
    unknowns = [unknown('level', 0.0, 1.0, prior=prior), unknown('slope', 0.0, 1.0)]
    columns = np.stack([np.ones_like(T), T], axis=1)
    return linear(columns, values, unknowns, independent or float(values.size)), columns


def test_the_promise_for_a_linear_problem_is_its_optimum():
    values = 1.0 + 0.3 * T + NOISE * np.random.default_rng(2).standard_normal(T.size)
    problem, columns = line(values)
    start = np.array([5.0, -2.0])
    r = problem.residuals(start)
    best = np.linalg.lstsq(columns, values, rcond=None)[0]
    least = problem.cost(best, problem.residuals(best))
    assert predicted_cost(problem, start, r, columns) == pytest.approx(least, abs=1e-3)
    one_step = solve(problem, start, 1)
    assert one_step.cost == pytest.approx(least, abs=1e-2)


def test_the_promise_of_an_effect_scales_what_it_does_but_not_backwards():
    wave = np.sin(3.0 * T)
    values = 1.0 + 0.3 * T + 0.2 * wave + NOISE * np.random.default_rng(2).standard_normal(T.size)
    problem, columns = line(values)
    known = solve(problem, np.zeros(2), 20, jacobian=columns)
    three = np.column_stack([columns, wave])
    left = three @ np.linalg.lstsq(three, values, rcond=None)[0] - values
    least = T.size * np.log(np.mean(left**2))
    for size in (0.01, 1.0):  # the effect at its start, too small or too large
        promise = amplified_cost(known, known.r + size * wave)
        assert promise == pytest.approx(least, abs=1e-3)
    assert amplified_cost(known, known.r - 0.1 * wave) == known.cost


def test_covariance_of_a_linear_problem_in_closed_form():
    values = 1.0 + 0.3 * T + NOISE * np.random.default_rng(3).standard_normal(T.size)
    independent = 90.0
    problem, columns = line(values, prior=0.004, independent=independent)
    solution = solve(problem, np.zeros(2), 40)
    variance = np.mean(solution.r**2) * T.size / independent
    expected = np.linalg.inv(columns.T @ columns / variance + np.diag([0.004**-2, 0.0]))
    np.testing.assert_allclose(solution.covariance(), expected, rtol=1e-6)


def test_covariance_survives_columns_of_any_size():
    columns = np.stack([np.ones_like(T), 1e-9 * T, 1e9 * T**2], axis=1)
    values = columns @ np.array([1.0, 1e9, 1e-9]) + np.sin(50.0 * T)
    problem = linear(columns, values, ('a', 'b', 'c'), float(T.size))
    solution = solve(problem, np.zeros(3), 40)
    normed = columns * np.array([1.0, 1e9, 1e-9])
    variance = np.mean(solution.r**2)
    expected = variance * np.diag(np.linalg.inv(normed.T @ normed))
    found = np.diag(solution.covariance()) * np.array([1.0, 1e-18, 1e18])
    np.testing.assert_allclose(found, expected, rtol=1e-2)


@pytest.mark.parametrize('rho', [0.0, 0.8])
def test_errors_scatter_as_the_covariance_says(rho):
    """Coloured noise is worth n (1 - rho) / (1 + rho) samples to a slow regressor."""
    rng = np.random.default_rng(4)
    independent = T.size * (1.0 - rho) / (1.0 + rho)
    found, said = [], []
    for _ in range(300):
        values = 1.0 + 0.3 * T + coloured(rng, T.size, rho, NOISE)
        problem, columns = line(values, independent=independent)
        solution = solve(problem, np.array([1.0, 0.3]), 5, jacobian=columns)
        found.append(solution.u)
        said.append(np.diag(solution.covariance()))
    ratio = np.var(found, axis=0) / np.mean(said, axis=0)
    np.testing.assert_allclose(ratio, 1.0, atol=0.3)
