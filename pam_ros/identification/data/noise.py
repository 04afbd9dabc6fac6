# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The noise floor of a measured signal: its size and its correlation, without any model."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import toeplitz
from scipy.optimize import brentq

Array = NDArray[np.float64]

WINDOWS = (0.25, 0.1)  # s: shorter than one period of a muscle's own oscillation
QUICK = 0.15  # ratio of the two noises below which the motion is too fast for long windows
SAMPLES = (12, 200)  # fewest and most samples in a window
DEGREE = 4  # of the polynomial that follows the motion within a window
LONGEST_CORRELATION = (
    0.05  # s, longest correlation time of noise: a slower error looks like motion
)
EVEN = 0.05  # largest deviation of a change from a multiple of the step, in steps
RANGE = 50  # fewest steps of a resolution in the range: a few levels are those of an experiment


@dataclass(frozen=True)
class Noise:
    """Standard deviation in the signal's unit, and correlation of neighbours (AR(1))."""

    sigma: float
    rho: float


def noise_of(
    signals: Sequence[tuple[Array, Array]], steps: Sequence[float] | None = None
) -> Noise:
    """Return the noise of gapless signals: stamps t (n,) in s and values (n,) of each.

    Polynomials of degree 4 are fitted to short windows. The quietest quarter of them shows the
    variance where the motion is smooth; windows with at most 1.8 times this variance are used. The
    part of AR(1) noise that a quartic removes is known exactly, and both moments of the residual
    are corrected for it. Slow drifts (slower than the window) count as motion, not as noise. If
    shorter windows give far less noise, the motion was too fast for the longer ones.

    *steps* are the resolutions of the signals; without it they are found by :func:`step_of`.
    Rounding to multiples of a step adds an error with the variance step^2/12, which is taken as
    white. It is nearly white if the other noise is at least half a step (Widrow and Kollar,
    Quantization Noise, 2008).
    """
    found = [step_of(values) for _, values in signals] if steps is None else steps
    long, short = (_in_windows(signals, found, window) for window in WINDOWS)
    return short if short.sigma < QUICK * long.sigma else long


def step_of(values: Array) -> float:
    """Return the resolution of values (n,): the step of which their differences are multiples.

    It is 0 if there is none, or if the values have a range of fewer than RANGE steps.
    """
    levels = np.unique(values)
    # Equal levels can differ by the rounding of the computer.
    changes = np.diff(levels)
    changes = changes[changes > 1e-9 * np.ptp(values)]
    if changes.size == 0 or levels.size == values.size:
        return 0.0
    # Files contain rounded values, so that the smallest change alone would not be accurate.
    multiples = np.round(changes / np.min(changes))
    if np.sum(multiples) < RANGE:
        return 0.0
    step = float(np.sum(changes) / np.sum(multiples))
    is_even = bool(np.all(np.abs(changes - multiples * step) < EVEN * step))
    return step if is_even else 0.0


@dataclass(frozen=True, eq=False)
class _Signal:
    """A signal: stamps t and values (n,), samples in a window, and variance of its rounding."""

    t: Array
    values: Array
    size: int
    rounding: float

    @property
    def period(self) -> float:
        return float(np.median(np.diff(self.t)))


def _in_windows(
    signals: Sequence[tuple[Array, Array]], steps: Sequence[float], window: float
) -> Noise:
    """Return the noise estimated from windows of *window* s."""
    used = _with_windows(signals, steps, window)
    if not used:
        spread = np.concatenate([v for _, v in signals])
        return Noise(float(np.std(np.diff(spread)) / np.sqrt(2.0)), 0.0)
    left = [_windows_without_motion(signal) for signal in used]
    power = np.concatenate([np.sum(e * e, axis=1) for e in left])
    lagged = np.concatenate([np.sum(e[:, 1:] * e[:, :-1], axis=1) for e in left])
    rounding = np.repeat([s.rounding for s in used], [len(e) for e in left])
    quiet = power <= 1.8 * np.quantile(power, 0.25)
    size, white = used[-1].size, float(np.mean(rounding[quiet]))
    a, b = _moments(size, 0.0)
    m0 = float(np.mean(power[quiet])) - white * a
    m1 = float(np.mean(lagged[quiet])) - white * b
    if m0 <= 0.0:
        return Noise(float(np.sqrt(white)), 0.0)
    rho = _correlation(m1 / m0, size, used[-1].period)
    variance = m0 / _moments(size, rho)[0]
    return Noise(float(np.sqrt(white + variance)), rho * variance / (white + variance))


def _with_windows(
    signals: Sequence[tuple[Array, Array]], steps: Sequence[float], window: float
) -> list[_Signal]:
    """Return the signals that are long enough for one of their windows of *window* s.

    Signals that are shorter than a window are used only if all of them are.
    """
    found = []
    for (t, values), step in zip(signals, steps, strict=True):
        if values.size >= 2 * (DEGREE + 1):
            signal = _Signal(t, values, values.size, step**2 / 12.0)
            size = int(np.clip(round(window / signal.period), *SAMPLES))
            found.append((signal, size))
    whole = [replace(signal, size=size) for signal, size in found if signal.size >= size]
    return whole or [signal for signal, _ in found]


def _windows_without_motion(signal: _Signal) -> Array:
    """Return the windows (w, size) of a signal, each without its polynomial.

    The stamps are the measured ones: at 0.1 m/s a change of a stamp by 0.1 ms is one of 10 um.
    """
    starts = np.arange(0, signal.values.size - signal.size + 1, max(1, signal.size // 2))
    windows = starts[:, None] + np.arange(signal.size)
    t, values = signal.t[windows], signal.values[windows]
    first, last = t[:, :1], t[:, -1:]
    basis = _basis((2.0 * t - first - last) / (last - first))
    parts = np.einsum('wij,wi->wj', basis, values)
    return np.asarray(values - np.einsum('wij,wj->wi', basis, parts))


def _basis(x: Array) -> Array:
    """Return orthonormal polynomials at x (..., n) up to DEGREE, as (..., n, DEGREE + 1)."""
    return np.asarray(np.linalg.qr(x[..., None] ** np.arange(DEGREE + 1))[0])


def _moments(size: int, rho: float) -> tuple[float, float]:
    """Return the expected sums of squares and of lagged products of unit AR(1) noise."""
    basis = _basis(np.linspace(-1.0, 1.0, size))
    maker = np.eye(size) - basis @ basis.T
    covariance = maker @ toeplitz(rho ** np.arange(size)) @ maker
    return float(np.trace(covariance)), float(np.sum(np.diag(covariance, 1)))


def _correlation(ratio: float, size: int, period: float) -> float:
    """Return the correlation of AR(1) noise whose moments have this *ratio*, or the nearest."""

    def error(rho: float) -> float:
        a, b = _moments(size, rho)
        return b / a - ratio

    low, high = 0.0, float(np.exp(-period / LONGEST_CORRELATION))
    if error(low) >= 0.0:
        return low
    if error(high) <= 0.0:
        return high
    return float(brentq(error, low, high, xtol=1e-3))
