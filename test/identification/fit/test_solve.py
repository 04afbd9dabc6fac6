# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fits against scipy and against ordinary and generalised least squares."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import optimize
from scipy.linalg import cholesky

from pam_ros.identification.fit.discrepancy import WHITE, Discrepancy
from pam_ros.identification.fit.solve import (
    FitStatus,
    Solution,
    initial_solution,
    least_squares,
    levenberg_marquardt,
    solve,
    with_fresh_jacobian,
)
from support.curves import LINE, NOISE, T, covariance, equation, line, slow_error
from support.equations import unknown

TRUTH = np.array([2.0, 0.8, 0.5])
# A fit ends when a step gains less than a tenth of -2 log likelihood.
CLOSE = 0.2
SLOW, QUICKER = Discrepancy(2.0, 0.5), Discrepancy(2.0, 0.1)
by_process = pytest.mark.parametrize('process', [WHITE, SLOW], ids=['white', 'slow error'])


def decay(u):
    return u[0] * np.exp(-u[1] * T) + u[2]


MEASURED = decay(TRUTH) + NOISE * np.random.default_rng(1).standard_normal(T.size)


def decaying(calls=None, **changes):
    """Return the problem of a decay; x=(low, high, prior) for x of a, b, c."""

    def function(u):
        if calls is not None:
            calls.append(u)
        return decay(u) - MEASURED

    unknowns = []
    for name in 'abc':
        low, high, prior = changes.get(name, (-np.inf, np.inf, 10.0))
        unknowns.append(unknown(name, 0.0, 1.0, low, high, prior))
    return equation(function, unknowns)


def by_scipy(problem, solution):
    """Return scipy's optimum of the same cost, the noise variance taken from *solution*."""
    root = np.linalg.inv(cholesky(covariance(solution.discrepancy), lower=True))
    low, high = problem.bounds

    def stacked(u):
        white = root @ problem.residuals(u)
        return np.concatenate([white / solution.noise, u / problem.prior])

    start = np.clip(np.ones(3), np.nextafter(low, np.inf), np.nextafter(high, -np.inf))
    return optimize.least_squares(
        stacked, start, bounds=(low, high), xtol=1e-12, ftol=1e-12, gtol=1e-12
    ).x


def start_at(problem, u, process=WHITE, jacobian=None):
    u = np.clip(np.array(u, dtype=float), *problem.bounds)
    r = problem.residuals(u)
    j = problem.jacobian(u, r) if jacobian is None else jacobian
    return Solution(problem, u, r, j, process, is_fresh=jacobian is None)


@pytest.mark.parametrize(
    'changes',
    [
        {},
        {'b': (0.0, 0.6, 10.0)},  # the bound is active
        {'a': (-np.inf, np.inf, 0.02), 'c': (-np.inf, np.inf, 0.01)},  # strong priors at 0
        {'a': (-np.inf, np.inf, 0.05), 'b': (1.0, 4.0, 10.0)},  # both
    ],
    ids=['plain', 'bound', 'priors', 'prior_and_bound'],
)
@pytest.mark.parametrize('start', [(1.0, 1.0, 0.0), (1.0, 1.5, 0.0), (3.0, 0.4, 1.0)])
@by_process
def test_ends_where_scipy_ends(changes, start, process):
    problem = decaying(**changes)
    solution = levenberg_marquardt(start_at(problem, start, process), 60)
    expected = by_scipy(problem, solution)
    least = start_at(problem, expected, process).cost
    assert solution.cost == pytest.approx(least, abs=CLOSE)
    slope = problem.jacobian(expected, problem.residuals(expected)) / solution.noise
    weighed = slope.T @ np.linalg.solve(covariance(process), slope)
    error = np.diag(weighed + np.diag(problem.prior**-2.0)) ** -0.5
    np.testing.assert_array_less(np.abs(solution.u - expected), 0.5 * error + 1e-12)
    low, high = problem.bounds
    assert np.all((solution.u >= low) & (solution.u <= high))
    np.testing.assert_array_equal(solution.r, problem.residuals(solution.u))
    assert solution.discrepancy == process


@settings(max_examples=40)
@given(st.integers(0, 10_000), st.booleans(), st.booleans())
def test_never_ends_higher_than_it_began(seed, rugged, slow):
    rng = np.random.default_rng(seed)
    columns, values = rng.standard_normal((T.size, 4)), rng.standard_normal(T.size)
    waves = 3.0 * rng.standard_normal((T.size, 4)) if rugged else np.zeros((T.size, 4))
    unknowns = [
        unknown(str(k), 0.0, 1.0, -1.0, 1.5, prior) for k, prior in enumerate((1, 9, 0.1, 3))
    ]
    problem = equation(lambda u: columns @ u + waves @ np.sin(5.0 * u) - values, unknowns)
    stale = rng.standard_normal((T.size, 4)) if seed % 2 else None
    process = SLOW if slow else WHITE
    begun = start_at(problem, rng.uniform(-1.0, 1.5, 4), process, stale)
    solution = levenberg_marquardt(begun, 6)
    assert solution.cost <= begun.cost + 1e-9
    assert np.all((solution.u >= -1.0) & (solution.u <= 1.5))


@pytest.mark.parametrize('start', [(4.46, 0.23, 0.15), (1.36, 0.2, 2.01), (5.83, 0.23, 0.35)])
def test_a_step_across_a_bound_does_not_end_the_fit_there(start):
    """From these starts the first step makes the amplitude negative, where none may be.

    An amplitude of 0 gives its rate no gradient, and with the rate that the same step led to, a
    positive amplitude is worse than none: a fit that is cut at the bound never leaves it.
    """
    problem = decaying(a=(0.0, np.inf, 10.0), b=(0.0, np.inf, 10.0))
    solution = levenberg_marquardt(start_at(problem, start), 60)
    expected = by_scipy(problem, solution)
    assert solution.cost == pytest.approx(start_at(problem, expected).cost, abs=CLOSE)


def test_an_optimum_on_a_bound_is_reached_exactly():
    problem = decaying(b=(0.0, 0.6, 10.0))
    assert levenberg_marquardt(start_at(problem, (1.0, 0.3, 0.0)), 60).u[1] == 0.6


def test_a_start_on_a_bound_leaves_it_where_the_cost_falls_inwards():
    problem = decaying(b=(0.3, 4.0, 10.0))
    solution = levenberg_marquardt(start_at(problem, (1.0, 0.3, 0.0)), 60)
    assert solution.cost == pytest.approx(
        levenberg_marquardt(start_at(problem, TRUTH), 60).cost, abs=CLOSE
    )


def test_a_start_outside_its_bounds_is_brought_in():
    problem = decaying(b=(0.5, 1.0, 10.0))
    assert 0.5 <= solve(problem, np.array([1.0, 7.0, 0.0])).u[1] <= 1.0


def test_a_value_is_found_by_name():
    solution = solve(decaying(), np.ones(3))
    assert solution.value('b') == solution.u[1]
    with pytest.raises(KeyError):
        solution.value('d')


def test_a_jacobian_kept_up_to_date_leads_to_the_same_optimum():
    problem = decaying(c=(-np.inf, np.inf, 0.3))
    exact = levenberg_marquardt(start_at(problem, (1.0, 1.5, 0.0)), 60)
    old = start_at(problem, (1.3, 1.2, 0.1)).jacobian
    for jacobian in (old, old * np.array([1.0, 0.3, 1.5]), np.zeros_like(old) + 0.1):
        kept = levenberg_marquardt(start_at(problem, (1.0, 1.5, 0.0), jacobian=jacobian), 60)
        assert kept.cost == pytest.approx(exact.cost, abs=CLOSE)


def test_a_good_jacobian_spares_computing_others():
    calls = []
    problem = decaying(calls)
    near = start_at(problem, TRUTH + 0.02)
    calls.clear()
    with_it = levenberg_marquardt(near)
    few = len(calls)
    calls.clear()
    without = levenberg_marquardt(start_at(problem, TRUTH + 0.02))
    assert with_it.cost == pytest.approx(without.cost, abs=CLOSE)
    assert few < len(calls)


@pytest.mark.parametrize('iterations', [3, 60])  # it has to stop, and has found the optimum
def test_a_fresh_jacobian_is_that_of_the_place(iterations):
    solution = levenberg_marquardt(start_at(decaying(), (1.0, 1.0, 0.0)), iterations)
    a, b, _ = solution.u
    exact = np.stack([np.exp(-b * T), -a * T * np.exp(-b * T), np.ones_like(T)], axis=1)
    np.testing.assert_allclose(with_fresh_jacobian(solution).jacobian, exact, atol=2e-3)


@pytest.mark.parametrize(
    ('iterations', 'status'), [(2, FitStatus.ITERATION_LIMIT), (60, FitStatus.CONVERGED)]
)
def test_a_fit_tells_how_it_ended_and_what_it_cost(iterations, status):
    calls = []
    problem = decaying(calls)
    first = initial_solution(problem, np.ones(3))
    assert (first.log.status, first.log.iterations) == (FitStatus.NOT_FITTED, 0)
    solution = with_fresh_jacobian(levenberg_marquardt(first, iterations))
    assert solution.log.status is status
    assert solution.log.iterations <= iterations
    assert solution.log.simulations == len(calls)


def test_a_jacobian_that_is_fresh_is_not_computed_again():
    calls = []
    solution = levenberg_marquardt(start_at(decaying(calls), (1.0, 1.0, 0.0)), 60)
    assert solution.is_fresh
    calls.clear()
    assert with_fresh_jacobian(solution) is solution
    assert calls == []
    # Nor when a fit goes on from there, which cannot get lower.
    assert levenberg_marquardt(solution, 60).cost == pytest.approx(solution.cost, abs=CLOSE)
    assert len(calls) < solution.u.size + 6


@by_process
def test_the_optimum_of_a_linear_problem_is_that_of_generalised_least_squares(process):
    values = 1.0 + 0.3 * T + NOISE * np.random.default_rng(3).standard_normal(T.size)
    solution = levenberg_marquardt(start_at(line(values, prior=0.004), (0.0, 0.0), process), 40)
    c = covariance(process)
    variance = solution.r @ np.linalg.solve(c, solution.r) / T.size
    assert solution.noise == pytest.approx(np.sqrt(variance), rel=1e-9)
    normal = LINE.T @ np.linalg.solve(c, LINE) / variance + np.diag([0.004**-2, 100.0**-2])
    best = np.linalg.solve(normal, LINE.T @ np.linalg.solve(c, values) / variance)
    np.testing.assert_allclose(solution.u, best, rtol=1e-3)


def test_least_squares_take_no_notice_of_a_discrepancy():
    values = LINE @ [1.0, 0.3] + slow_error(np.random.default_rng(8), SLOW)
    known = least_squares(solve(line(values), np.zeros(2)), 40)
    best, *_ = np.linalg.lstsq(LINE, values, rcond=None)
    np.testing.assert_allclose(known.u, best, rtol=1e-4)
    assert known.discrepancy == WHITE
    exact = known.problem.jacobian(known.u, known.r)
    # It may be that of the place before, from which a step lowered the cost by nothing any more.
    np.testing.assert_allclose(known.jacobian, exact, rtol=2e-3, atol=1e-3)


@by_process
def test_the_score_of_a_linear_problem_is_its_evidence(process):
    """That is the normal density of the data with the unknowns integrated out, -2 ln of it."""
    values = 1.0 + 0.3 * T + NOISE * np.random.default_rng(3).standard_normal(T.size)
    solution = with_fresh_jacobian(
        levenberg_marquardt(start_at(line(values, prior=0.5), (0.0, 0.0), process), 40)
    )
    spread = LINE * np.array([0.5, 100.0])
    whole = solution.noise**2 * covariance(process) + spread @ spread.T
    _, log_det = np.linalg.slogdet(whole)
    exact = log_det + values @ np.linalg.solve(whole, values)
    assert solution.score + T.size == pytest.approx(exact, abs=1e-3)


def test_a_discrepancy_that_is_not_there_is_not_found_for_a_decay():
    solution = solve(decaying(), np.ones(3))
    assert solution.discrepancy == WHITE
    assert solution.noise == pytest.approx(NOISE, rel=0.1)


def test_a_slow_error_is_found_next_to_a_decay():
    values = decay(TRUTH) + slow_error(np.random.default_rng(6), SLOW)
    unknowns = [unknown(name, prior=10.0) for name in 'abc']
    solution = solve(equation(lambda u: decay(u) - values, unknowns), np.ones(3))
    assert 1.0 < solution.discrepancy.size < 4.0
    assert 0.2 < solution.discrepancy.time < 1.2
    np.testing.assert_allclose(solution.u, TRUTH, atol=0.3)


def test_a_cheap_look_shortens_its_steps_until_one_leads_down():
    """A line with a tenth of its amplitude: the full step in frequency is ten times too long."""
    values = 10.0 * np.sin(2.0 * np.pi * T + 1.0)

    def left(u):
        angle = 2.0 * np.pi * u[2] * T
        return u[0] * np.sin(angle) + u[1] * np.cos(angle) - values

    names = ('sine', 'cosine', 'frequency')
    first = initial_solution(
        equation(left, [unknown(one, prior=100.0) for one in names]), [1.0, 1.0, 1.03]
    )
    look = levenberg_marquardt(first, 4, renew=False)
    assert np.linalg.norm(look.r) < 0.5 * np.linalg.norm(first.r)
