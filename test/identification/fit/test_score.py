# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The score of linear models, whose evidence is known exactly."""

import numpy as np
import pytest
from scipy.linalg import toeplitz
from scipy.stats import multivariate_normal

from pam_ros.identification.fit.discrepancy import WHITE, Discrepancy, deviance
from pam_ros.identification.fit.score import most_likely, score
from pam_ros.identification.fit.slopes import Slopes

T = np.sort(np.random.default_rng(11).uniform(0.0, 3.0, 120))
NOISE = np.random.default_rng(5).normal(0.0, 0.3, T.size)
COLUMNS = np.stack([np.ones(T.size), T, np.sin(2.0 * T)], axis=1)
PRIOR = np.array([2.0, 0.5, 3.0])


def one_run(jacobian):
    """Return the slopes of a single run."""
    return Slopes.of([jacobian], [np.arange(jacobian.shape[1])])


def most_probable(y, columns, prior, whitening):
    """Return z, W y, W J and sigma^2 where the posterior of y = J P z + error is greatest."""
    target, jacobian = whitening(y), whitening(columns)
    variance = 1.0
    for _ in range(200):
        a = prior[:, None] * (jacobian.T @ jacobian) * prior / variance + np.eye(prior.size)
        z = np.linalg.solve(a, prior * (jacobian.T @ target) / variance)
        left = target - jacobian @ (prior * z)
        variance = float(left @ left) / left.size
    return z, left, jacobian, variance


@pytest.mark.parametrize('process', [WHITE, Discrepancy(1.5, 0.4)], ids=['white', 'slow error'])
@pytest.mark.parametrize('size', [0, 1, 3])
def test_it_is_the_evidence_of_a_linear_model(process, size):
    """Which is the normal density of the data with the unknowns integrated out."""
    columns, prior = COLUMNS[:, :size], PRIOR[:size]
    y = COLUMNS @ np.array([1.0, -0.4, 0.7]) + NOISE
    whitening = process.whitening(T)
    z, left, jacobian, variance = most_probable(y, columns, prior, whitening)
    found = score(left, one_run(-jacobian), z, prior, whitening.log_det)
    distance = np.abs(T[:, None] - T[None, :])
    noise = np.eye(T.size) + process.size**2 * np.exp(-distance / process.time)
    spread = columns * prior
    exact = multivariate_normal(np.zeros(T.size), variance * noise + spread @ spread.T).logpdf(y)
    constant = T.size * (1.0 + np.log(2.0 * np.pi))
    assert found + constant == pytest.approx(-2.0 * exact, rel=1e-9)


def of_residuals(t, runs):
    """Return the most likely discrepancy of residuals of a model without unknowns."""
    r, columns = np.concatenate(runs), [np.empty((run.size, 0)) for run in runs]
    return most_likely(t, r, Slopes.of(columns, [np.empty(0, int)] * len(t)), *[np.empty(0)] * 2)


def drawn(process, t, random):
    """Return a residual of a process at even stamps, by the Cholesky factor of its covariance."""
    first = np.exp(-t / process.time) * process.size**2
    return np.linalg.cholesky(toeplitz(first) + np.eye(t.size)) @ random.normal(size=t.size)


@pytest.mark.slow
@pytest.mark.parametrize('process', [Discrepancy(3.0, 0.2), Discrepancy(0.5, 1.0)], ids=str)
def test_the_most_likely_process_is_near_the_true_one(process):
    t, random = np.arange(2000) * 0.02, np.random.default_rng(1)
    runs = [drawn(process, t, random) for _ in range(6)]
    found = of_residuals([t] * 6, runs)
    assert found.size == pytest.approx(process.size, rel=0.3)
    assert found.time == pytest.approx(process.time, rel=0.4)
    # No other is more likely, of those that a finer grid has.
    whitenings = [found.whitening(t)] * 6
    best = deviance([whitenings[0](y) for y in runs], whitenings)
    for size in process.size * np.linspace(0.5, 2.0, 7):
        for time in process.time * np.linspace(0.5, 2.0, 7):
            other = [Discrepancy(size, time).whitening(t)] * 6
            assert best < deviance([other[0](y) for y in runs], other) + 0.01


@pytest.mark.slow
def test_white_noise_has_no_discrepancy():
    t = np.arange(1000) * 0.01
    found = [of_residuals([t], [np.random.default_rng(k).normal(size=t.size)]) for k in range(20)]
    assert sum(one == WHITE for one in found) >= 17
    assert all(one.size < 0.3 for one in found)


def test_units_of_residual_and_time_change_nothing():
    """A residual in other units, and time in others, have the same process."""
    t = np.arange(800) * 0.01
    y = drawn(Discrepancy(1.0, 0.3), t, np.random.default_rng(7))
    one, other = of_residuals([t], [y]), of_residuals([1000.0 * t], [1e-6 * y])
    assert other.size == pytest.approx(one.size, rel=1e-6)
    assert other.time == pytest.approx(1000.0 * one.time, rel=1e-6)


def test_unknowns_that_were_fitted_do_not_hide_the_slow_part():
    """A curve with eight waves follows half of a slow error: what is left must not count alone."""
    t, random = np.arange(600) * 0.02, np.random.default_rng(12)
    process = Discrepancy(4.0, 1.0)
    waves = np.stack([np.cos(np.pi * k * t / 12.0) for k in range(8)], axis=1)
    prior = np.full(8, 30.0)
    spreads = {'with': [], 'without': []}
    for _ in range(20):
        y = drawn(process, t, random)
        z, _, _, _ = most_probable(y, waves, prior, process.whitening(t))
        left = y - waves @ (prior * z)
        with_it = most_likely([t], left, one_run(-waves), z, prior)
        spreads['with'].append(with_it.size**2 * with_it.time)
        alone = of_residuals([t], [left])
        spreads['without'].append(alone.size**2 * alone.time)
    true = process.size**2 * process.time  # the process' spectral density at rest, half of it
    assert np.median(spreads['without']) < 0.5 * true
    assert 0.6 * true < np.median(spreads['with']) < 1.7 * true


def test_derivatives_beside_which_one_is_lost_have_a_finite_score():
    """Two equal columns: 1 + J'J is singular to the last digit, and its logarithm was -inf."""
    jacobian = 1e12 * np.ones((T.size, 2))
    found = score(NOISE, one_run(jacobian), np.zeros(2), np.ones(2), 0.0)
    variance = np.mean(NOISE**2)
    price = np.log1p(2.0 * T.size * 1e24 / variance)
    assert found == pytest.approx(T.size * np.log(variance) + price, rel=1e-9)
