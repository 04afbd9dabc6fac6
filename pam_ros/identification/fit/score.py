# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One score for any two models of the same recordings: their evidence, by Laplace's method.

The evidence of a model is the probability of the data under it, integrated over its unknowns:

    p(y) = integral p(y | z) p(z) dz

with the residual y, white after the map W of :mod:`pam_ros.identification.fit.discrepancy`, and
unknowns u = P z, where P has the standard deviations of their priors and z ~ N(0, 1). Laplace's
method approximates the posterior by a normal distribution around its maximum (MacKay, Information
Theory, Inference and Learning Algorithms, 2003, chapter 27). With the Jacobian J of W y there,

    -2 ln p(y) = |W y|^2 / sigma^2 + n ln(2 pi sigma^2) + ln det C
                 + z'z + ln det(1 + P J'J P / sigma^2)

This is exact if y is linear in u. The last term is the cost of the unknowns: it grows with the
information that the data add to the priors, so that no additional count of parameters is needed.
At the most likely sigma^2 = |W y|^2 / n the first two terms are n ln sigma^2 + n (1 + ln 2 pi),
of which the second part is the same for all models and is left out.

A difference of 10 between two models is very strong evidence (Kass and Raftery 1995).

The size and the time of the discrepancy are those of the best score. The likelihood alone would
treat the unknowns as known, although they were fitted to the same residuals. Then the slow part of
the error would be too small, and the intervals of the unknowns too short. The last term is the
correction of a restricted likelihood (Patterson and Thompson 1971).
"""

from collections.abc import Sequence
from math import log

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from pam_ros.identification.fit.discrepancy import WHITE, Discrepancy, deviance
from pam_ros.identification.fit.slopes import Slopes, product

Array = NDArray[np.float64]

# Search for the discrepancy: factors between the times and between the sizes of its grid.
FACTOR_TIME, FACTOR_SIZE = 8.0, 20.0
LEAST_SIZE, GREATEST_SIZE = 1e-2, 1e3  # beyond it the process, or the noise, is negligible
# Least fall of the score for two more numbers: Akaike's (1974) price of a parameter, 2 each.
PRICE = 4.0
# Largest correlation time, as a share of the longest run. An error that is constant over a whole
# run would be an offset without cost, so that the level of the measurement would have no
# influence. Less than ten correlation times also contain little information on a process.
LONGEST_SHARE = 0.1
CLOSE = 0.05  # accuracy of the best score: small compared with a margin of 10
STEP = 1e-2  # of the logarithms, for derivatives of the score, which is smooth in them


def score(whitened: Array, slopes: Slopes, z: Array, prior: Array, log_det: float) -> float:
    """Return -2 ln(evidence) without a constant of the data: the lower, the better the model.

    *whitened* (n,) is the residual W y at the most probable unknowns, of all runs one after the
    other, *slopes* (n, k) are its derivatives by the unknowns u, *z* (k,) the unknowns in standard
    deviations of their priors *prior* (k,), all finite, and *log_det* the sum of ln det C of the
    runs.
    """
    square = float(whitened @ whitened)
    return _score(whitened.size, square, slopes.normal(), z, prior) + log_det


def _score(n: int, square: float, normal: Array, z: Array, prior: Array) -> float:
    """Return the score without ln det C; *square* is |W y|^2, *normal* J'W'W J (k, k)."""
    variance = square / n
    scaled = normal * np.outer(prior, prior)
    _, price = np.linalg.slogdet(np.eye(prior.size) + scaled / variance)
    if not np.isfinite(price):
        # Derivatives of a cheap fit can be so large that 1 is lost, and the sum is singular.
        price = np.sum(np.log1p(np.maximum(np.linalg.eigvalsh(scaled / variance), 0.0)))
    return float(n * np.log(variance) + z @ z + price)


def most_likely(
    t: Sequence[Array], residuals: Array, slopes: Slopes, z: Array, prior: Array
) -> Discrepancy:
    """Return the discrepancy with which a model has its best score.

    *t* are the stamps of the runs in s; *residuals* (n,), of all runs one after the other, and
    *slopes* (n, k) are not whitened, *z* and *prior* as in :func:`score`. The result is
    WHITE unless another one lowers the score by more than the price of its two numbers.
    Correlation times are searched from the sampling period to a tenth of the longest run.
    """
    edges = np.cumsum([stamps.size for stamps in t])[:-1]
    # The residual and its derivatives are filtered in one pass if they are columns of an array.
    apart = np.split(residuals, edges)
    parts = [np.column_stack(both) for both in zip(apart, slopes.blocks, strict=True)]
    places = [np.append(0, 1 + own) for own in slopes.columns]

    def cost(z_of: Array) -> float:
        return score_of(Discrepancy(*np.exp(z_of)))

    def score_of(discrepancy: Discrepancy) -> float:
        maps = [discrepancy.whitening(stamps) for stamps in t]
        normal = np.zeros((1 + z.size, 1 + z.size))
        for whitening, part, place in zip(maps, parts, places, strict=True):
            white = whitening(part)
            normal[np.ix_(place, place)] += product(white, white)
        log_det = sum(w.log_det for w in maps)
        return _score(residuals.size, normal[0, 0], normal[1:, 1:], z, prior) + log_det

    period = float(np.median(np.concatenate([np.diff(stamps) for stamps in t])))
    span = max(float(stamps[-1] - stamps[0]) for stamps in t)
    longest = max(LONGEST_SHARE * span, 2.0 * period)
    low, high = np.log([LEAST_SIZE, period]), np.log([GREATEST_SIZE, longest])
    grid = [
        np.array([size, time])
        for size in _steps(low[0], high[0], log(FACTOR_SIZE))
        for time in _steps(low[1], high[1], log(FACTOR_TIME))
    ]
    # For the starting point the likelihood of the residuals alone is sufficient, and cheap.
    start = min(grid, key=lambda z_of: _likely(Discrepancy(*np.exp(z_of)), t, apart))
    found = minimize(
        cost,
        start,
        method='SLSQP',
        bounds=np.column_stack([low, high]),
        options={'eps': STEP, 'ftol': CLOSE},
    )
    if found.fun > score_of(WHITE) - PRICE:
        return WHITE
    size, time = np.exp(found.x).tolist()
    return Discrepancy(size, time)


def _likely(discrepancy: Discrepancy, t: Sequence[Array], residuals: Sequence[Array]) -> float:
    """Return -2 ln(likelihood) of the *residuals* (n,) of the runs, without a constant."""
    maps = [discrepancy.whitening(stamps) for stamps in t]
    return deviance([w(part) for w, part in zip(maps, residuals, strict=True)], maps)


def _steps(low: float, high: float, step: float) -> Array:
    return np.linspace(low, high, 2 + int((high - low) / step))
