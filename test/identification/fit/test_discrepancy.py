# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Whitened residuals against the dense covariance, and processes that are known."""

import numpy as np
import pytest
from scipy.linalg import cho_factor, cho_solve

from pam_ros.identification.fit.discrepancy import WHITE, Discrepancy, deviance

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
def test_the_covariance_times_columns_is_that_of_the_dense_one(process, t):
    values = np.random.default_rng(5).normal(size=(t.size, 3))
    given = values.copy()
    np.testing.assert_allclose(
        process.times(t, values), covariance(process, t) @ values, rtol=1e-9, atol=1e-9
    )
    np.testing.assert_array_equal(values, given)


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
