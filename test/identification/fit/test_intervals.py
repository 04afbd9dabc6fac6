# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Intervals against dense matrices, and against errors that are drawn again and again."""

import numpy as np
import pytest

from pam_ros.identification.fit.discrepancy import WHITE, Discrepancy
from pam_ros.identification.fit.intervals import covariance
from pam_ros.identification.fit.solve import begun, fresh, improved, least_squares
from support import curves
from support.curves import LINE, T, equation, line, slow_error
from support.equations import unknown

SLOW, QUICKER = Discrepancy(2.0, 0.5), Discrepancy(2.0, 0.1)
TRUTH = np.array([1.0, 0.3])


def fitted(values, prior=100.0):
    """Return the straight line of least squares through *values* over T."""
    return least_squares(begun(line(values, prior), TRUTH), 40)


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
    known = fresh(improved(begun(line(values, prior), TRUTH, SLOW), 40))
    c = curves.covariance(SLOW)
    variance = known.r @ np.linalg.solve(c, known.r) / T.size
    normal = LINE.T @ np.linalg.solve(c, LINE) / variance + np.diag([prior**-2, 100.0**-2])
    np.testing.assert_allclose(covariance(known, SLOW), np.linalg.inv(normal), rtol=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ('process', 'least'),
    [(WHITE, 0.88), (QUICKER, 0.87), (SLOW, 0.75)],
    ids=['white noise', 'correlated for a 50th of the record', 'for a tenth of it'],
)
def test_they_hold_the_truth_nearly_as_often_as_they_say(process, least):
    """95 % of them within 1.96 standard errors, with a process that is estimated, too.

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
        inside += off < 1.96 * np.sqrt(np.diag(covariance(known, found)))
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
    other = covariance(least_squares(begun(problem, TRUTH / units), 40), SLOW)
    expected = covariance(fitted(values), SLOW)
    np.testing.assert_allclose(other * np.outer(units, units), expected, rtol=1e-3)
