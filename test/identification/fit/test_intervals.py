# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Intervals against dense matrices, and against errors that are drawn again and again."""

import numpy as np
import pytest
from scipy.linalg import sqrtm
from scipy.stats import norm, t

from pam_ros.identification.fit.discrepancy import WHITE, Discrepancy
from pam_ros.identification.fit.intervals import (
    BLOCKS,
    block_variances,
    blocks,
    covariance,
    half_widths,
)
from pam_ros.identification.fit.solve import (
    Solution,
    initial_solution,
    least_squares,
    levenberg_marquardt,
    with_fresh_jacobian,
)
from support import curves
from support.curves import LINE, NOISE, T, equation, line, slow_error
from support.equations import unknown

SLOW, QUICKER = Discrepancy(2.0, 0.5), Discrepancy(2.0, 0.1)
TRUTH = np.array([1.0, 0.3])


def fitted(values, prior=100.0):
    """Return the straight line of least squares through *values* over T."""
    return least_squares(initial_solution(line(values, prior), TRUTH), 40)


@pytest.mark.parametrize('process', [WHITE, SLOW], ids=['white', 'slow error'])
@pytest.mark.parametrize('prior', [0.01, 100.0])
def test_the_covariance_is_that_of_the_linear_map_from_the_errors(process, prior):
    """The estimate is a linear map of the errors and of what the priors are off: no algebra."""
    known = fitted(LINE @ TRUTH + slow_error(np.random.default_rng(3), process), prior)
    spread = np.diag([prior, 100.0])
    weight = T.size / float(known.r @ known.r)
    gain = np.linalg.inv(weight * LINE.T @ LINE + np.linalg.inv(spread**2)) @ LINE.T * weight
    c = curves.covariance(process)
    white = known.r @ np.linalg.solve(c, known.r) / T.size
    missed = gain @ LINE - np.eye(2)
    expected = white * gain @ c @ gain.T + missed @ spread**2 @ missed.T
    np.testing.assert_allclose(covariance(known, process), expected, rtol=1e-3)


@pytest.mark.parametrize('prior', [0.01, 100.0])
def test_under_the_process_itself_it_is_that_of_generalised_least_squares(prior):
    values = LINE @ TRUTH + slow_error(np.random.default_rng(3), SLOW)
    known = with_fresh_jacobian(
        levenberg_marquardt(initial_solution(line(values, prior), TRUTH, SLOW), 40)
    )
    c = curves.covariance(SLOW)
    variance = known.r @ np.linalg.solve(c, known.r) / T.size
    normal = LINE.T @ np.linalg.solve(c, LINE) / variance + np.diag([prior**-2, 100.0**-2])
    np.testing.assert_allclose(covariance(known, SLOW), np.linalg.inv(normal), rtol=1e-4)


def dense(basis, r, spread):
    """Return the variances by blocks and by priors as written, with matrices of all samples."""
    weight = r.size / float(r @ r)
    inverse = np.linalg.inv(weight * basis.T @ basis + np.diag(spread**-2.0))
    moved = []
    for block in np.array_split(np.arange(r.size), BLOCKS):
        own = basis[block]
        left = np.eye(block.size) - weight * own @ inverse @ own.T
        moved.append(weight * inverse @ own.T @ np.linalg.solve(sqrtm(left), r[block]))
    of_priors = np.diag(inverse @ np.diag(spread**-2.0) @ inverse)
    return np.sum(np.square(moved), axis=0), of_priors


@pytest.mark.parametrize('process', [WHITE, SLOW], ids=['white', 'slow error'])
@pytest.mark.parametrize('prior', [0.01, 100.0])
def test_variances_by_blocks_are_those_of_the_dense_matrices(process, prior):
    known = fitted(LINE @ TRUTH + slow_error(np.random.default_rng(3), process), prior)
    expected = dense(LINE, known.r, np.array([prior, 100.0]))
    np.testing.assert_allclose(block_variances(known), expected, rtol=1e-3)


def test_of_a_fit_with_a_discrepancy_they_are_those_of_its_whitened_samples():
    values = LINE @ TRUTH + slow_error(np.random.default_rng(3), SLOW)
    known = with_fresh_jacobian(
        levenberg_marquardt(initial_solution(line(values), TRUTH, SLOW), 40)
    )
    root = np.linalg.inv(np.linalg.cholesky(curves.covariance(SLOW)))
    expected = dense(root @ LINE, root @ known.r, np.full(2, 100.0))
    np.testing.assert_allclose(block_variances(known), expected, rtol=3e-3)


@pytest.mark.parametrize('is_slow', [True, False], ids=['slow error', 'noise that grows'])
def test_an_interval_is_the_longer_one_of_process_and_blocks(is_slow):
    rng = np.random.default_rng(3)
    noise = NOISE * rng.standard_normal(T.size) * np.where(T > 4.0, 10.0, 1.0)
    known = fitted(LINE @ TRUTH + (slow_error(rng, SLOW) if is_slow else noise))
    found = known.most_likely()
    process = 1.96 * np.sqrt(np.diag(covariance(known, found)))
    of_blocks, of_priors = block_variances(known)
    factors = t.ppf(0.975, BLOCKS - 1), norm.ppf(0.975)
    of_both = np.sqrt(factors[0] ** 2 * of_blocks + factors[1] ** 2 * of_priors)
    np.testing.assert_allclose(half_widths(known, found), np.maximum(process, of_both), rtol=1e-4)
    assert (process > of_both)[1] == is_slow


def test_what_the_data_do_not_determine_has_the_interval_of_its_prior():
    values = LINE @ TRUTH + NOISE * np.random.default_rng(2).standard_normal(T.size)
    unknowns = [unknown(name, prior=3.0) for name in ('level', 'slope', 'idle')]
    known = least_squares(
        initial_solution(equation(lambda u: LINE @ u[:2] - values, unknowns), np.zeros(3))
    )
    assert half_widths(known, WHITE)[2] == pytest.approx(1.96 * 3.0, rel=1e-3)


def test_two_unknowns_that_act_alike_have_the_interval_of_their_difference():
    """Their sum is known exactly; J'J holds no digit of their difference."""
    basis = 1e8 * np.stack([T, T], axis=1)
    r = NOISE * np.random.default_rng(2).standard_normal(T.size)
    problem = equation(lambda u: basis @ u + r, [unknown(name, prior=3.0) for name in 'ab'])
    known = Solution(problem, np.zeros(2), r, basis)
    np.testing.assert_allclose(half_widths(known, WHITE), 1.96 * 3.0 / np.sqrt(2.0), rtol=1e-3)


def test_a_short_run_is_a_block_and_a_long_one_several(monkeypatch):
    known = fitted(LINE @ TRUTH + slow_error(np.random.default_rng(3), WHITE))
    sizes = (300, 10, 90)
    monkeypatch.setattr(
        type(known.problem), 'stamps', lambda problem: [np.arange(size) for size in sizes]
    )
    assert [(one.start, one.stop) for one in blocks(known)] == [
        (0, 50), (50, 100), (100, 150), (150, 200), (200, 250), (250, 300),
        (300, 310), (310, 355), (355, 400),
    ]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    ('process', 'least'),
    [(WHITE, 0.88), (QUICKER, 0.87), (SLOW, 0.75)],
    ids=['white noise', 'correlated for a 50th of the record', 'for a tenth of it'],
)
def test_they_hold_the_truth_nearly_as_often_as_they_say(process, least):
    """95 % of them, with a process that is estimated, too.

    What ten correlation times say of the process is little, and the intervals do not hold that.
    """
    rng = np.random.default_rng(4)
    draws, white = 60, 0
    inside, plain = np.zeros(2), np.zeros(2)
    for _ in range(draws):
        known = fitted(LINE @ TRUTH + slow_error(rng, process))
        found = known.most_likely()
        white += found == WHITE
        off = np.abs(known.u - TRUTH)
        inside += off < half_widths(known, found)
        plain += off < 1.96 * np.sqrt(np.diag(covariance(known, WHITE)))
    assert np.all(inside >= least * draws)
    if process is WHITE:
        assert white >= 0.9 * draws
    else:
        assert white == 0
        # This is why: taken for white, the same residuals promise far too much.
        assert np.all(plain < 0.7 * draws)


def test_units_of_the_unknowns_lose_no_digits():
    values = LINE @ TRUTH + slow_error(np.random.default_rng(5), SLOW)
    units = np.array([1e-9, 1e9])
    unknowns = [unknown(str(k), prior=100.0 / unit) for k, unit in enumerate(units)]
    problem = equation(lambda u: (LINE * units) @ u - values, unknowns)
    other = covariance(least_squares(initial_solution(problem, TRUTH / units), 40), SLOW)
    expected = covariance(fitted(values), SLOW)
    np.testing.assert_allclose(other * np.outer(units, units), expected, rtol=1e-3)
