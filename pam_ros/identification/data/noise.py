# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The noise floor of a measured signal: its size and its correlation, without any model."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import toeplitz
from scipy.optimize import brentq

Array = NDArray[np.float64]

WINDOWS = (0.25, 0.1)  # s: shorter than one period of a muscle's own oscillation
QUICK = 0.15  # ratio of the two noises below which the motion is too fast for long windows
SAMPLES = (12, 200)  # fewest and most samples in a window
DEGREE = 4  # of the polynomial that follows the motion within a window


@dataclass(frozen=True)
class Noise:
    """Standard deviation in the signal's unit, and correlation of neighbours (AR(1))."""

    sigma: float
    rho: float

    @property
    def independent(self) -> float:
        """Independent samples per sample, (1 - rho)/(1 + rho), for slow regressors."""
        return (1.0 - self.rho) / (1.0 + self.rho)


def noise_of(signals: Sequence[tuple[Array, Array]]) -> Noise:
    """Return the noise of signals (t, values), each gapless and about evenly sampled.

    Polynomials of degree 4 are fitted to short windows. The quietest quarter of them shows the
    variance where the motion is smooth; windows with at most 1.8 times this variance are used. The
    part of AR(1) noise that a quartic removes is known exactly, and both moments of the residual
    are corrected for it. Slow drifts (slower than the window) count as motion, not as noise. If
    shorter windows give far less noise, the motion was too fast for the longer ones.
    """
    long, short = (_in_windows(signals, window) for window in WINDOWS)
    return short if short.sigma < QUICK * long.sigma else long


def _in_windows(signals: Sequence[tuple[Array, Array]], window: float) -> Noise:
    """Return the noise estimated from windows of *window* s."""
    zero: list[Array] = []
    one: list[Array] = []
    size = 0
    for values, size in _of_window_size(signals, window):
        starts = np.arange(0, values.size - size + 1, max(1, size // 2))
        windows = values[starts[:, None] + np.arange(size)]
        left = windows @ _residual_maker(size)
        zero.append(np.sum(left * left, axis=1))
        one.append(np.sum(left[:, 1:] * left[:, :-1], axis=1))
    if not zero:
        spread = np.concatenate([v for _, v in signals])
        return Noise(float(np.std(np.diff(spread)) / np.sqrt(2.0)), 0.0)
    power, lagged = np.concatenate(zero), np.concatenate(one)
    quiet = power <= 1.8 * np.quantile(power, 0.25)
    m0, m1 = float(np.mean(power[quiet])), float(np.mean(lagged[quiet]))
    if m0 <= 0.0:
        return Noise(0.0, 0.0)

    def ratio(rho: float) -> float:
        a, b = _moments(size, rho)
        return b / a - m1 / m0

    low, high = 0.0, 0.98
    if ratio(low) >= 0.0:
        rho = low
    elif ratio(high) <= 0.0:
        rho = high
    else:
        rho = float(brentq(ratio, low, high, xtol=1e-3))
    return Noise(float(np.sqrt(m0 / _moments(size, rho)[0])), rho)


def _of_window_size(
    signals: Sequence[tuple[Array, Array]], window: float
) -> list[tuple[Array, int]]:
    """Return the values of signals, each with the number of samples in one of its windows.

    Signals that are shorter than a window are used only if all of them are.
    """
    found = []
    for t, values in signals:
        if values.size >= 2 * (DEGREE + 1):
            period = float(np.median(np.diff(t)))
            found.append((values, int(np.clip(round(window / period), *SAMPLES))))
    whole = [(values, size) for values, size in found if values.size >= size]
    return whole or [(values, values.size) for values, _ in found]


def _residual_maker(size: int) -> Array:
    basis = np.linalg.qr(np.vander(np.linspace(-1.0, 1.0, size), DEGREE + 1))[0]
    return np.asarray(np.eye(size) - basis @ basis.T)


def _moments(size: int, rho: float) -> tuple[float, float]:
    """Return the expected sums of squares and of lagged products of unit AR(1) noise."""
    maker = _residual_maker(size)
    covariance = maker @ toeplitz(rho ** np.arange(size)) @ maker
    return float(np.trace(covariance)), float(np.sum(np.diag(covariance, 1)))


def independent_share(residual: Array, longest: int) -> float:
    """Return the independent samples per sample of a residual, from its autocorrelation.

    It is one over the integrated autocorrelation time, which is summed up to its first negative
    value or *longest* samples. This is the weight of a residual with structure in a test.
    """
    e = residual - np.mean(residual)
    n = e.size
    spectrum = np.abs(np.fft.rfft(e, 2 * n)) ** 2
    correlation = np.fft.irfft(spectrum)[: min(longest, n)]
    if correlation[0] <= 0.0:
        return 1.0
    correlation /= correlation[0]
    negative = np.flatnonzero(correlation < 0.0)
    end = negative[0] if negative.size else correlation.size
    return float(1.0 / (1.0 + 2.0 * np.sum(correlation[1:end])))
