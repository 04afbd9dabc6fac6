# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Whitened residuals against the dense covariance, and processes that are known."""

import numpy as np
import pytest
from scipy.linalg import cho_factor, cho_solve, toeplitz
from scipy.signal import lfilter

from pam_ros.identification.fit.discrepancy import WHITE, Discrepancy, deviance, most_likely

EVEN = np.arange(300) * 0.01
UNEVEN = np.sort(np.random.default_rng(3).uniform(0.0, 4.0, 250))
GAP = np.concatenate([EVEN[:100], EVEN[:100] + 7.0])
STAMPS = {'even': EVEN, 'uneven': UNEVEN, 'with a gap': GAP, 'one sample': EVEN[:1]}
by_stamps = pytest.mark.parametrize('t', STAMPS.values(), ids=STAMPS)
by_process = pytest.mark.parametrize(
    'process',
    [Discrepancy(2.0, 0.3), Discrepancy(0.05, 20.0), Discrepancy(300.0, 1.0), WHITE],
    ids=str,
)


def covariance(process, t):
    """Return C of the docstring, entry by entry."""
    distance = np.abs(t[:, None] - t[None, :])
    return np.eye(t.size) + process.size**2 * np.exp(-distance / process.time)


@by_process
@by_stamps
def test_the_map_makes_white_what_has_the_covariance(process, t):
    """W C W' = 1, and with it all of generalised least squares."""
    w = process.whitening(t)(np.eye(t.size))
    assert w.shape == (t.size, t.size)
    c = covariance(process, t)
    np.testing.assert_allclose(w @ c @ w.T, np.eye(t.size), atol=1e-9)
    assert np.all(np.triu(w, 1) == 0.0)  # it knows nothing of what is to come


@by_process
@by_stamps
def test_the_likelihood_is_that_of_the_dense_covariance(process, t):
    y = np.random.default_rng(4).normal(size=t.size)
    whitening = process.whitening(t)
    found = deviance([whitening(y)], [whitening])
    factor = cho_factor(covariance(process, t), lower=True)
    square = float(y @ cho_solve(factor, y))
    log_det = 2.0 * np.sum(np.log(np.diag(factor[0])))
    assert found == pytest.approx(t.size * np.log(square / t.size) + log_det, rel=1e-9, abs=1e-9)


def test_a_jacobian_is_whitened_column_by_column():
    whitening = Discrepancy(1.5, 0.2).whitening(UNEVEN)
    columns = np.random.default_rng(5).normal(size=(UNEVEN.size, 3))
    found = whitening(columns)
    for k in range(3):
        np.testing.assert_array_equal(found[:, k], whitening(columns[:, k]))


def test_even_samples_are_an_arma_process_of_first_order_each():
    """Its filter in the long run is (1 - phi/z)/(1 - theta/z), with theta of a quadratic."""
    size, time, dt = 0.7, 0.5, 0.01
    phi = np.exp(-dt / time)
    ratio = size**2 * (1.0 - phi**2)  # variance of what drives the process, over that of the noise
    b = (ratio + 1.0 + phi**2) / phi
    theta = (b - np.sqrt(b * b - 4.0)) / 2.0
    t = np.arange(5000) * dt
    y = np.random.default_rng(6).normal(size=t.size)
    late = Discrepancy(size, time).whitening(t)(y)[3000:]
    expected = lfilter([1.0, -phi], [1.0, -theta], y)[3000:]
    np.testing.assert_allclose(late, expected * np.sqrt(theta / phi), rtol=1e-9)


def drawn(process, t, random):
    """Return a residual of a process at even stamps, by the Cholesky factor of its covariance."""
    first = np.exp(-t / process.time) * process.size**2
    return np.linalg.cholesky(toeplitz(first) + np.eye(t.size)) @ random.normal(size=t.size)


@pytest.mark.slow
@pytest.mark.parametrize('process', [Discrepancy(3.0, 0.2), Discrepancy(0.5, 1.0)], ids=str)
def test_the_most_likely_process_is_near_the_true_one(process):
    t, random = np.arange(2000) * 0.02, np.random.default_rng(1)
    runs = [drawn(process, t, random) for _ in range(6)]
    found = most_likely([t] * 6, runs)
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
    found = [most_likely([t], [np.random.default_rng(k).normal(size=t.size)]) for k in range(20)]
    assert sum(one == WHITE for one in found) >= 17
    assert all(one.size < 0.3 for one in found)


def test_units_of_residual_and_time_change_nothing():
    """A residual in other units, and time in others, have the same process."""
    t = np.arange(800) * 0.01
    y = drawn(Discrepancy(1.0, 0.3), t, np.random.default_rng(7))
    one, other = most_likely([t], [y]), most_likely([1000.0 * t], [1e-6 * y])
    assert other.size == pytest.approx(one.size, rel=1e-6)
    assert other.time == pytest.approx(1000.0 * one.time, rel=1e-6)
