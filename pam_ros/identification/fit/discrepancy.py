# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The model of a residual: white noise of the sensor, and a slow error of the model.

No model has exactly the form of the real system, and the resulting error is correlated in time: a
thousand samples of a slow error contain hardly more information than one. So the residual y of a
run is modelled as

    y_i = w_i + d_i,  w_i ~ N(0, sigma^2),  cov(d_i, d_j) = (size sigma)^2 exp(-|t_i - t_j|/time),

with independent samples of the noise w, and a first-order Gauss-Markov (Ornstein-Uhlenbeck)
process d, the discrepancy of Kennedy and O'Hagan (2001). At equidistant stamps y is an ARMA(1,1).
A Kalman filter with the single state d turns y into innovations that are independent (Durbin and
Koopman, Time Series Analysis by State Space Methods, 2012, section 4.3). Divided by their
standard deviations, in units of sigma, they are the whitened residual. This is a linear map W with
W C W' = 1, where sigma^2 C is the covariance of y. So the sum of squares of W y is y' C^-1 y, and
ordinary least squares of whitened residuals and a whitened Jacobian are generalised least squares.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import log, sqrt

import numpy as np
from numpy.typing import NDArray

from pam_ros.compiled import cached

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Whitening:
    """The map W of one run with n samples.

    ``decay`` (n,) is the factor by which d decays to the next sample, ``gain`` (n,) that of the
    Kalman filter, ``scale`` (n,) one over the standard deviation of the innovation in units of
    sigma. ``log_det`` is ln det C.
    """

    decay: Array
    gain: Array
    scale: Array
    log_det: float

    def __call__(self, values: Array) -> Array:
        """Return W times *values*, (n,) or (n, k): a residual, or the columns of a Jacobian."""
        columns = np.ascontiguousarray(values, dtype=float)
        found = np.empty_like(columns)
        rows = (self.scale.size, -1)
        _innovations(self.decay, self.gain, self.scale, columns.reshape(rows), found.reshape(rows))
        return found


@dataclass(frozen=True)
class Discrepancy:
    """The slow error of a model, in addition to white noise.

    ``size`` is its standard deviation over that of the noise, 0 without such an error; ``time`` is
    its correlation time in s.
    """

    size: float = 0.0
    time: float = 1.0

    def whitening(self, t: Array) -> Whitening:
        """Return the map that whitens values at the stamps t (n,), ascending, in s.

        Each run has its own map, since nothing is known before its first sample.
        """
        decay = np.append(np.exp(-np.diff(t) / self.time), 0.0)
        gain, scale = np.empty(t.size), np.empty(t.size)
        log_det = _gains(float(self.size) ** 2, decay, gain, scale)
        return Whitening(decay, gain, scale, log_det)

    def times(self, t: Array, values: Array) -> Array:
        """Return C times the columns of *values* (n, k), of a run with the stamps t (n,)."""
        found = np.array(values, dtype=float, order='C')
        decay = np.exp(-np.diff(t) / self.time)
        _correlated(float(self.size) ** 2, decay, np.ascontiguousarray(values, dtype=float), found)
        return found


WHITE = Discrepancy()


def deviance(whitened: Sequence[Array], whitenings: Sequence[Whitening]) -> float:
    """Return -2 ln(likelihood) of runs at the most likely sigma, without n (1 + ln 2 pi).

    *whitened* are the residuals W y of the runs (n,), *whitenings* are their maps.
    """
    n = sum(e.size for e in whitened)
    square = sum(float(e @ e) for e in whitened)
    return n * log(square / n) + sum(w.log_det for w in whitenings)


@cached
def _gains(variance: float, decay: Array, gain: Array, scale: Array) -> float:
    """Fill *gain* and *scale* of the Kalman filter; return ln det C. Variances over sigma^2."""
    # p: variance of d at a sample, given the samples before. A product of few innovations cannot
    # overflow, and needs fewer logarithms.
    log_det, product, p = 0.0, 1.0, variance
    for i in range(decay.size):
        innovation = p + 1.0
        gain[i] = p / innovation
        scale[i] = 1.0 / sqrt(innovation)
        product *= innovation
        if product > 1e100:
            log_det += log(product)
            product = 1.0
        left = decay[i] * decay[i]
        p = left * gain[i] + variance * (1.0 - left)  # p (1 - gain) is the gain in these units
    return log_det + log(product)


@cached
def _innovations(decay: Array, gain: Array, scale: Array, values: Array, found: Array) -> None:
    """Fill *found* (n, k) with the innovations of the columns of *values* (n, k) times *scale*."""
    # The filter's state d is stored in the next row of *found*. All columns are filtered in one
    # pass, since a recursion cannot be vectorised along time.
    n, columns = values.shape
    found[0, :] = 0.0
    for i in range(n):
        for k in range(columns):
            d = found[i, k]
            innovation = values[i, k] - d
            found[i, k] = innovation * scale[i]
            if i + 1 < n:
                found[i + 1, k] = decay[i] * (d + gain[i] * innovation)


@cached
def _correlated(variance: float, decay: Array, values: Array, found: Array) -> None:
    """Add to *found* (n, k) the product of the covariance of d and *values* (n, k)."""
    n, columns = values.shape
    for k in range(columns):
        before, after = 0.0, 0.0
        found[n - 1, k] += variance * values[n - 1, k]
        for i in range(n - 1):
            before = decay[i] * (before + values[i, k])
            found[i, k] += variance * values[i, k]
            found[i + 1, k] += variance * before
        for i in range(n - 2, -1, -1):
            after = decay[i] * (after + values[i + 1, k])
            found[i, k] += variance * after
