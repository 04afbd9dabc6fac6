# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recursive least squares against the batch solution."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from pam_ros.control.learning.regression import Regression

ALIKE = np.array([[1.0, 0.9, 0.0], [0.9, 1.0, 0.0], [0.0, 0.0, 1.0]])


@pytest.mark.parametrize(('samples', 'correlation'), [(200, None), (5, ALIKE)])
def test_it_is_the_batch_solution_with_the_prior(samples, correlation):
    rng = np.random.default_rng(1)
    spread, noise = np.array([2.0, 0.5, 5.0]), 0.3
    far = np.full(3, 1e9)
    found = Regression(spread, -far, far, noise, correlation)
    phi = rng.normal(size=(samples, 3))
    y = phi @ [1.0, -0.3, 4.0] + rng.normal(size=samples) * noise**0.5
    for row, value in zip(phi, y, strict=True):
        found.update(row, value - row @ found.theta, 0.0)
    prior = np.eye(3) if correlation is None else correlation
    information = phi.T @ phi / noise + np.linalg.inv(prior * np.outer(spread, spread))
    np.testing.assert_allclose(found.theta, np.linalg.solve(information, phi.T @ y / noise))
    np.testing.assert_allclose(found.covariance, np.linalg.inv(information), atol=1e-12)


def test_a_parameter_that_is_not_seen_follows_the_one_that_is_like_it():
    """The first alone is seen, for a long time; then the second, which is another one."""
    spread, far = np.array([0.05, 0.05]), np.full(2, 1e9)
    found = Regression(spread, -far, far, 1e-4, np.array([[1.0, 0.9], [0.9, 1.0]]))
    for _ in range(200):
        found.update((1.0, 0.0), 0.06 - found.theta[0], 1e-4)
    assert found.theta == pytest.approx([0.06, 0.9 * 0.06], abs=1e-3)
    # What the first does not say of it, also of its drift.
    left = (1.0 - 0.9**2) * (1.0 + 200 * 1e-4)
    assert found.covariance[1, 1] == pytest.approx(left * 0.05**2, rel=0.02)
    for _ in range(200):
        found.update((0.0, 1.0), 0.02 - found.theta[1], 1e-3)
    assert found.theta[1] == pytest.approx(0.02, abs=1e-3)


def test_no_variance_exceeds_its_prior_however_much_is_forgotten():
    spread, far = np.array([0.05, 0.05]), np.full(2, 1e9)
    correlation = np.array([[1.0, 0.9], [0.9, 1.0]])
    found = Regression(spread, -far, far, 1e-4, correlation)
    for _ in range(50):
        found.update((1.0, -0.5), 0.0, 0.0)
    for _ in range(50):
        found.update((0.0, 0.0), 0.0, 1.0)
    assert np.diagonal(found.covariance) == pytest.approx(0.05**2)
    assert 0.8 * 0.05**2 < found.covariance[0, 1] < 0.9 * 0.05**2


def test_bounds_hold_and_no_spread_keeps_a_parameter():
    found = Regression(np.array([1.0, 0.0]), np.zeros(2), np.ones(2), 0.1)
    for _ in range(100):
        found.update(np.array([1.0, 1.0]), 5.0 - sum(found.theta), 0.0)
    assert found.theta == [1.0, 0.0]


@pytest.mark.parametrize('seed', range(8))
def test_within_bounds_it_is_the_regularised_batch_solution_within_bounds(seed):
    """Also of parameters whose features are almost the same, as in the beginning of a motion."""
    rng = np.random.default_rng(seed)
    spread, noise = np.array([20.0, 20.0, 10.0, 100.0]), 0.25
    low, high = np.array([0.0, 0.0, -5.0, -300.0]), np.array([60.0, 60.0, 30.0, 300.0])
    found = Regression(spread, low, high, noise)
    common = rng.normal(size=(300, 1))
    phi = common + 0.05 * rng.normal(size=(300, 4))
    true = np.append(-8.0, rng.uniform(-10.0, 10.0, 3))
    y = phi @ true + rng.normal(size=300) * noise**0.5
    for row, value in zip(phi, y, strict=True):
        found.update(row, value - row @ found.theta, 0.0)
    rows = np.vstack([phi / noise**0.5, np.diag(1.0 / spread)])
    best = lsq_linear(rows, np.append(y / noise**0.5, np.zeros(4)), (low, high), tol=1e-14)
    assert best.active_mask.any()
    np.testing.assert_allclose(found.theta, best.x, atol=0.01)


def test_one_parameter_is_forgotten_and_the_others_are_kept():
    rng = np.random.default_rng(2)
    far = np.full(2, 1e9)
    found = Regression(np.array([2.0, 3.0]), -far, far, 0.1)
    for row in rng.normal(size=(50, 2)):
        found.update(row, row @ [1.0, -2.0] - row @ found.theta, 0.0)
    known, variance = found.theta[0], found.covariance[0, 0]
    found.forget(1, 5.0)
    assert found.theta == [known, 5.0]
    np.testing.assert_array_equal(found.covariance, np.diag([variance, 9.0]))


def test_it_goes_on_from_what_another_one_has_found():
    """The same samples move both alike, where the parameter that only one has is not seen."""
    rng = np.random.default_rng(3)
    low, high, spread = np.array([0.0, -9.0, -9.0]), np.full(3, 9.0), np.array([4.0, 4.0, 0.0])
    known = Regression(spread, low, high, 0.1)
    found = Regression(np.full(3, 4.0), low, high, 0.1)

    def sample(one, row):
        one.update(row, row @ [-2.0, 1.0, 0.0] - row @ one.theta, 0.0)

    for row in rng.normal(size=(40, 3)):
        sample(known, row * [1.0, 1.0, 0.0])
        sample(found, 5.0 * row)
    found.restart_from(known, slice(2, 3))
    assert found.theta == known.theta
    for row in rng.normal(size=(5, 3)):
        sample(known, row * [1.0, 1.0, 0.0])
        sample(found, row * [1.0, 1.0, 0.0])
    np.testing.assert_allclose(found.theta, known.theta, atol=1e-9)
    assert found.covariance[2, 2] == 16.0


def test_what_is_left_of_the_prior_variance_is_that_of_the_least_certain_parameter():
    """Y = a alone says nothing of b; a and b in turn say the same of both."""
    spread = np.array([2.0, 5.0, 0.1])
    found = Regression(spread, np.full(3, -9.0), np.full(3, 9.0), noise=0.5)
    both = slice(0, 2)
    assert found.uncertainty(both) == 1.0
    for _ in range(10):
        found.update((1.0, 0.0, 0.0), 0.0, 0.0)
    assert found.uncertainty(both) == 1.0
    of_a = found.uncertainty(slice(0, 1))
    assert of_a == pytest.approx(1.0 / (1.0 + 10.0 * 4.0 / 0.5))  # of a normal prior
    for _ in range(10):
        found.update((0.0, 1.0, 0.0), 0.0, 0.0)
    assert found.uncertainty(both) == pytest.approx(of_a)
    assert found.uncertainty(slice(2, 3)) == 1.0
