# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The score of linear models, whose evidence is known exactly."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from pam_ros.identification.fit.discrepancy import WHITE, Discrepancy
from pam_ros.identification.fit.score import score

T = np.sort(np.random.default_rng(11).uniform(0.0, 3.0, 120))
NOISE = np.random.default_rng(5).normal(0.0, 0.3, T.size)
COLUMNS = np.stack([np.ones(T.size), T, np.sin(2.0 * T)], axis=1)
PRIOR = np.array([2.0, 0.5, 3.0])


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
    found = score(left, -jacobian, z, prior, whitening.log_det)
    distance = np.abs(T[:, None] - T[None, :])
    noise = np.eye(T.size) + process.size**2 * np.exp(-distance / process.time)
    spread = columns * prior
    exact = multivariate_normal(np.zeros(T.size), variance * noise + spread @ spread.T).logpdf(y)
    constant = T.size * (1.0 + np.log(2.0 * np.pi))
    assert found + constant == pytest.approx(-2.0 * exact, rel=1e-9)


def scores(y, sizes=(2, 3)):
    """Return the scores of a line, and of a line with a sine."""
    found = []
    for size in sizes:
        columns, prior = COLUMNS[:, :size], PRIOR[:size]
        z, left, jacobian, _ = most_probable(y, columns, prior, WHITE.whitening(T))
        found.append(score(left, -jacobian, z, prior, 0.0))
    return found


def test_a_term_that_is_there_is_preferred_and_one_that_is_not_costs():
    line = COLUMNS[:, :2] @ np.array([1.0, -0.4])
    plain, finer = scores(line + NOISE)
    assert finer > plain  # a parameter that explains nothing costs
    plain, finer = scores(line + 0.5 * COLUMNS[:, 2] + NOISE)
    assert finer < plain - 10.0


def test_a_parameter_of_which_more_was_known_costs_less():
    y = COLUMNS[:, :2] @ np.array([1.0, -0.4]) + NOISE
    found = []
    for known in (0.1, 1.0, 10.0):
        prior = np.array([2.0, 0.5, known])
        z, left, jacobian, _ = most_probable(y, COLUMNS, prior, WHITE.whitening(T))
        found.append(score(left, -jacobian, z, prior, 0.0))
    assert found[0] < found[1] < found[2]


def test_other_units_of_the_unknowns_change_nothing():
    y = COLUMNS[:, 1] + NOISE
    z, left, jacobian, _ = most_probable(y, COLUMNS, PRIOR, WHITE.whitening(T))
    units = np.array([1e3, 1e-2, 7.0])
    one = score(left, -jacobian, z, PRIOR, 0.0)
    other = score(left, -jacobian / units, z, PRIOR * units, 0.0)
    assert other == pytest.approx(one, rel=1e-12)
