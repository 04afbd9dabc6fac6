# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The structure of a residual: how much of it a generic regressor can predict."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

RATE = 50.0  # Hz to which signals are thinned: structure is slower, and noise averages out
LAGS = (0.0, 0.06, 0.2, 0.6, 2.0)  # s
FOLDS = 6
RIDGES = (1e-1, 1e1, 1e3)


@dataclass(frozen=True)
class Structure:
    """How much of a residual is predictable.

    ``ceiling``: cross-validated R^2 of a generic regressor on lagged p, y, v, their products and
    time; near 0 if nothing is missing. ``whiteness``: p value of the test of Ljung and Box. It is
    only reported, since it rejects almost everything at 100 Hz and more. ``share``: the part of
    the residual's variance that is above the noise floor.
    """

    ceiling: float
    whiteness: float
    share: float


def structure_of(t: Array, residual: Array, inputs: Sequence[Array], floor: float) -> Structure:
    """Return the structure of *residual* (n,) at stamps t (n,), gapless.

    *inputs* are the pressure of each muscle, then position and velocity (n,) of the model, without
    the noise of the measurement: a regressor on measured signals would predict their noise from
    itself. If only pressures were recorded, the command and the rate of the pressure take the
    places of position and velocity. *floor* is the standard deviation of the noise.
    """
    period = float(np.median(np.diff(t)))
    stride = max(1, round(1.0 / (RATE * period)))
    e = _thin(residual, stride)
    signals = [_thin(s, stride) for s in inputs]
    variance = float(np.mean(residual**2))
    share = max(0.0, 1.0 - floor**2 / variance) if variance > 0.0 else 0.0
    if e.size < 20 * FOLDS:
        return Structure(0.0, ljung_box(residual), share)
    x = _features(_thin(t, stride), signals, stride * period)
    return Structure(_ceiling(x, e), ljung_box(residual), share)


def _thin(values: Array, stride: int) -> Array:
    """Return means over *stride* neighbours."""
    n = values.size // stride * stride
    return np.asarray(values[:n].reshape(-1, stride).mean(axis=1))


def _features(t: Array, signals: list[Array], period: float) -> Array:
    p, *others, y, v = [(s - s.mean()) / (s.std() + 1e-12) for s in signals]
    sign = np.tanh(v / 0.05)
    base = [p, y, v, sign, p * p, y * y, p * y, p * v, y * v, v * np.abs(v), p * sign, y * sign]
    cubic = [y**3, p**3, y * y * p, np.sin(3.0 * y), np.cos(3.0 * y), np.sin(6.0 * y)]
    for other in others:
        base += [other, other * other, other * y, other * v, other * sign, other * p]
        cubic += [other**3, y * y * other]
    columns = []
    for lag in LAGS:
        k = round(lag / period)
        for c in base:
            columns.append(np.concatenate([np.full(k, c[0]), c[: c.size - k]]))
    span = (t - t[0]) / (t[-1] - t[0]) - 0.5
    drift = [span, span**2, span**3, span * p, span * y]
    x = np.stack([*columns, *cubic, *drift], axis=1)
    return np.asarray((x - x.mean(axis=0)) / (x.std(axis=0) + 1e-12))


def _ceiling(x: Array, e: Array) -> float:
    """Return the best R^2 over the ridges, predicted block by block from the other blocks."""
    block = (np.arange(e.size) * FOLDS) // e.size
    total = float(np.sum((e - e.mean()) ** 2))
    if total <= 0.0:
        return 0.0
    best = 0.0
    for ridge in RIDGES:
        left = 0.0
        for k in range(FOLDS):
            test = block == k
            a, b = x[~test], e[~test]
            mean = b.mean()
            w = np.linalg.solve(a.T @ a + ridge * np.eye(x.shape[1]), a.T @ (b - mean))
            left += float(np.sum((e[test] - mean - x[test] @ w) ** 2))
        best = max(best, 1.0 - left / total)
    return best


def ljung_box(residual: Array, lags: int = 20) -> float:
    """Return the p value of Ljung and Box's test of no autocorrelation up to *lags*."""
    from scipy.stats import chi2

    e = residual - residual.mean()
    n = e.size
    power = float(e @ e)
    if power <= 0.0 or n <= lags:
        return 1.0
    rho = np.array([e[k:] @ e[:-k] for k in range(1, lags + 1)]) / power
    statistic = n * (n + 2) * float(np.sum(rho**2 / (n - np.arange(1, lags + 1))))
    return float(chi2.sf(statistic, lags))
