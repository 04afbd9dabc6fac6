# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How far the unknowns of a fit may be off, where its errors are correlated.

Of all estimates the least squares of the residuals as they are bring the simulation nearest to the
measurement, and that is what a simulator is for; the most probable ones under a discrepancy leave
slow errors where they are, for these cost little. But where errors are correlated, n samples say
less than n independent ones. With residuals of the covariance sigma^2 C, see
:mod:`pam_ros.identification.fit.discrepancy`, the mean square s^2 that a fit leaves of n of them,
their Jacobian J and the standard deviations P of the priors,

    cov(u) = A (sigma^2/s^4 J'C J + P^-2) A,   A = (J'J/s^2 + P^-2)^-1

(White 1980; Newey and West 1987). Where errors are white, or were whitened before, C is 1, and
cov(u) is A.
"""

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.fit.discrepancy import Discrepancy
from pam_ros.identification.fit.solve import Solution

Array = NDArray[np.float64]


def covariance(known: Solution, process: Discrepancy) -> Array:
    """Return the covariance of the unknowns u (k, k) of a fit.

    *process* is what its residuals are made of beside white noise. The fit was made by least
    squares, or under this very process. The process' own uncertainty, which counts where a run is
    not many correlation times long, is not in it.
    """
    problem = known.problem
    prior = problem.prior
    one = np.eye(prior.size)
    # Scaled by the priors no number is so large or small that the inverse loses digits.
    slope = problem.whitened(known.jacobian * prior, known.whitenings)
    square = float(np.mean(known.whitened**2))
    inverse = np.linalg.inv(slope.T @ slope / square + one)
    if known.discrepancy != process:
        parts = zip(problem.stamps(), problem.by_run(slope), strict=True)
        spread = np.concatenate([process.times(t, part) for t, part in parts])
        whitened = problem.whitened(known.r, problem.whitenings(process))
        scatter = float(np.mean(whitened**2)) / square**2 * (slope.T @ spread) + one
        inverse = inverse @ scatter @ inverse
    return np.asarray(inverse * np.outer(prior, prior))
