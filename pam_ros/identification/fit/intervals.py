# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The covariance of the unknowns of a fit, if its errors are correlated.

The least-squares estimates from residuals without whitening bring the simulation nearest to the
measurement, which is the purpose of a simulator. The most probable estimates under a
discrepancy keep slow errors, since these cost little. But if errors are correlated, n samples
contain less information than n independent ones. With the covariance sigma^2 C of the residuals,
see :mod:`pam_ros.identification.fit.discrepancy`, the mean square s^2 of the n residuals of a fit,
their Jacobian J and the standard deviations P of the priors,

    cov(u) = A (sigma^2/s^4 J'C J + P^-2) A,   A = (J'J/s^2 + P^-2)^-1

(White 1980; Newey and West 1987). If errors are white, or were whitened before, C is 1, and
cov(u) is A.
"""

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.fit.discrepancy import Discrepancy
from pam_ros.identification.fit.solve import Solution

Array = NDArray[np.float64]


def covariance(known: Solution, process: Discrepancy) -> Array:
    """Return the covariance of the unknowns u (k, k) of a fit.

    *process* is the correlated part of its residuals, in addition to white noise. The fit was made
    by least squares, or with this process. The uncertainty of the process itself is not included;
    it matters if a run is not many correlation times long.
    """
    problem = known.problem
    prior = problem.prior
    one = np.eye(prior.size)
    # After scaling by the priors no number is so large or small that the inverse loses digits.
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
