# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The intervals of the unknowns of a fit whose errors are correlated.

The least-squares estimates from residuals without whitening bring the simulation nearest to the
measurement, which is the purpose of a simulator. The most probable estimates under a
discrepancy keep slow errors, since these cost little. But if errors are correlated, n samples
contain less information than n independent ones. With the covariance sigma^2 C of the residuals,
see :mod:`pam_ros.identification.fit.discrepancy`, the mean square s^2 of the n residuals of a fit,
their Jacobian J and the standard deviations P of the priors,

    cov(u) = A (sigma^2/s^4 J'C J + P^-2) A,   A = (J'J/s^2 + P^-2)^-1

(White 1980; Newey and West 1987). If errors are white, or were whitened before, C is 1, and
cov(u) is A.

The error of a model without the form of the real system is often not such a process: it depends
on what the rig does, and displaces the estimates. The cluster-robust covariance (Liang and Zeger
1986) assumes no form, only that the errors in different blocks of the recordings are nearly
independent. With the residuals r_b and the Jacobian J_b of each of B blocks,

    cov(u) = sum d_b d_b' + A P^-2 A,   d_b = A J_b' (1 - H_b)^(-1/2) r_b/s^2,

with H_b = J_b A J_b'/s^2. The residuals of a block are smaller than its errors, most of all if few
blocks determine a parameter. The factor with H_b corrects this: for white errors, the sum is
unbiased (Bell and McCaffrey 2002, Survey Methodology 28(2), 169-181). For the sum
over blocks, an interval uses the quantile of Student's t with B - 1 degrees of freedom.

The first covariance is too small for errors of another form. The second is too small if a single
block determines a parameter, or if errors are correlated for longer than a block. The longer of
the two intervals is used.
"""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.stats import norm
from scipy.stats import t as student

from pam_ros.identification.fit.discrepancy import Discrepancy
from pam_ros.identification.fit.slopes import product
from pam_ros.identification.fit.solve import Solution

Array = NDArray[np.float64]
# Errors of a model are correlated for up to some seconds, as long as a motion lasts. A block must
# be longer; of a recording of a minute it is 7 s. With fewer blocks the intervals become wide.
BLOCKS = 8
TAIL = 0.975  # probability below the upper end of a 95 % interval
ROWS = 256  # that are decomposed at once: they stay in the cache of a processor
LEAST = 1e-12  # of the eigenvalues of 1 - H_b, which are positive except for rounding


def half_widths(solution: Solution, process: Discrepancy) -> Array:
    """Return half the length of the 95 % interval of each unknown u (k,) of a fit.

    *process* is that of :func:`covariance`.
    """
    of_process = np.diag(covariance(solution, process))
    of_blocks, of_priors = block_variances(solution)
    normal, freedom = norm.ppf(TAIL), len(blocks(solution)) - 1
    square = student.ppf(TAIL, freedom) ** 2 * of_blocks + normal**2 * of_priors
    return np.asarray(np.sqrt(np.maximum(normal**2 * of_process, square)))


def covariance(solution: Solution, process: Discrepancy) -> Array:
    """Return the covariance of the unknowns u (k, k) of a fit whose errors are a *process*.

    *process* is the correlated part of its residuals, in addition to white noise. The fit was made
    by least squares, or with this process. The uncertainty of the process itself is not included;
    it matters if a run is not many correlation times long.
    """
    problem = solution.problem
    slope, root, s = _scaled(solution)
    inverse = root @ root.T
    if solution.discrepancy != process:
        parts = zip(problem.stamps(), problem.by_run(slope), strict=True)
        spread = np.concatenate([process.times(t, part) for t, part in parts])
        whitened = problem.whitened(solution.r, problem.whitenings(process))
        scatter = float(np.mean(whitened**2)) / s**2 * product(slope, spread)
        inverse = inverse @ (scatter + np.eye(problem.prior.size)) @ inverse
    return np.asarray(inverse * np.outer(problem.prior, problem.prior))


def block_variances(solution: Solution) -> tuple[Array, Array]:
    """Return the variances of the unknowns u (k,) by the blocks, and by the priors.

    With A = L L' and K = J_b L/s, d_b = L (1 - K'K)^(-1/2) K' r_b/s needs only small matrices.
    """
    slope, root, s = _scaled(solution)
    found = np.zeros(len(root))
    for block in blocks(solution):
        own = slope[block] @ root
        values, vectors = np.linalg.eigh(product(own, own))
        change = vectors.T @ (own.T @ solution.whitened[block]) / s
        change /= np.sqrt(np.maximum(1.0 - values, LEAST))
        found += (root @ (vectors @ change)) ** 2
    unit = solution.problem.prior**2
    return unit * found, unit * np.sum((root @ root.T) ** 2, axis=0)


def blocks(solution: Solution) -> list[slice]:
    """Return the samples of each block: parts of nearly the same size, or a short run."""
    sizes = [t.size for t in solution.problem.stamps()]
    longest = sum(sizes) / BLOCKS
    found, start = [], 0
    for size in sizes:
        parts = max(1, round(size / longest))
        ends = start + np.linspace(0, size, parts + 1).round().astype(int)
        found += [slice(*block) for block in pairwise(ends)]
        start += size
    return found


def _scaled(solution: Solution) -> tuple[Array, Array, float]:
    """Return J/s, L and s, of whitened residuals and of unknowns in units of their priors.

    L is a triangular matrix with A = L L', from a QR decomposition of J/s and the priors. If two
    unknowns act alike, J'J has no digits of their difference, and neither A nor L would be found
    from it. The decomposition takes in some rows after the others (Demmel et al. 2012, SIAM J.
    Sci. Comput. 34(1), A206-A239).
    """
    problem = solution.problem
    s = float(np.sqrt(np.mean(solution.whitened**2)))
    slope = problem.whitened(solution.jacobian * problem.prior, solution.whitenings) / s
    unit = np.eye(problem.prior.size)
    triangle = unit
    for i in range(0, len(slope), ROWS):
        rows = np.vstack([triangle, slope[i : i + ROWS]])
        triangle = np.asarray(np.linalg.qr(rows, mode='r'))
    return slope, np.asarray(solve_triangular(triangle, unit), dtype=float), s
