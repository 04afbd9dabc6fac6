# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Statistics of the residuals of several runs: sizes, correlations, spectra.

Residuals are measured - simulated. Runs are lists of arrays, one for each gapless segment.
Statistics over time combine the segments and never extend across a gap.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import correlate, csd, welch
from scipy.stats import t as student

Array = NDArray[np.float64]

BATCHES = 20
CONFIDENCE = 0.95
LJUNG = 2.576  # quantile of the normal distribution for bands that contain 99 %
COHERENCE_WINDOWS = 8  # fewest windows of a coherence; fewer hardly distinguish it from chance
SHORTEST = 8  # samples of a window


@dataclass(frozen=True)
class Size:
    """The size of an error, in the unit of the target.

    rmse with its 95 % interval low..high, fit in percent (100: no error, 0: no better than the
    mean), maximum of the magnitude; NaN if there are no samples.
    """

    rmse: float
    low: float
    high: float
    fit_percent: float
    maximum: float


def size_of(residuals: Sequence[Array], targets: Sequence[Array]) -> Size:
    """Return the size of residuals (n,) of some runs with these measured targets (n,).

    The interval is computed from the spread of the mean square of twenty batches in time, each of
    which should be longer than the correlation time of the residual. With fewer than forty samples
    it has no width. fit = 100 (1 - |e| / |y - mean y|), NaN for constant targets.
    """
    e = np.concatenate(residuals) if residuals else np.empty(0)
    if e.size == 0:
        nan = float('nan')
        return Size(nan, nan, nan, nan, nan)
    y = np.concatenate(targets)
    square = e * e
    mean = float(square.mean())
    low = high = mean
    if e.size >= 2 * BATCHES:
        batches = np.array([part.mean() for part in np.array_split(square, BATCHES)])
        error = float(batches.std(ddof=1) / np.sqrt(BATCHES))
        reach = float(student.ppf(0.5 + 0.5 * CONFIDENCE, BATCHES - 1)) * error
        low, high = max(mean - reach, 0.0), mean + reach
    spread = float(np.linalg.norm(y - y.mean()))
    fit = 100.0 * (1.0 - float(np.linalg.norm(e)) / spread) if spread > 0.0 else float('nan')
    return Size(mean**0.5, low**0.5, high**0.5, fit, float(np.max(np.abs(e))))


def resampled(t: Array, values: Array, period: float) -> Array:
    """Return the means of a signal over windows of *period* s, or its values if it is slower.

    Means instead of samples, so that higher frequencies do not alias.
    """
    own = float(np.median(np.diff(t)))
    stride = max(1, round(period / own))
    n = int((t[-1] - t[0]) / own + 0.5) + 1
    even = np.interp(t[0] + own * np.arange(n), t, values)
    n = n // stride * stride
    return np.asarray(even[:n].reshape(-1, stride).mean(axis=1))


def autocorrelation(parts: Sequence[Array], lags: int) -> tuple[Array, float]:
    """Return the autocorrelation (lags + 1,) of evenly sampled parts, and its 95 % band."""
    total = np.zeros(lags + 1)
    count = 0
    for part in _centred(parts):
        total += _lagged(part, part, 0, lags)
        count += part.size
    if total[0] <= 0.0:
        return np.zeros(lags + 1), 1.0
    return total / total[0], 1.96 / float(np.sqrt(max(count, 1)))


def cross_correlation(
    inputs: Sequence[Array], residuals: Sequence[Array], before: int, after: int
) -> tuple[Array, float]:
    """Return the correlation of residual(t + lag) with input(t) at lags -before..after.

    The band contains 99 % of the values of a residual that is independent of the input, for any
    spectra of the two: 2.58 sqrt(sum R_e R_u / N) (Ljung, System Identification, 1999, section
    16.6).
    """
    reach = 10 * max(before, after)
    cross = np.zeros(before + after + 1)
    colour_e, colour_u = np.zeros(reach + 1), np.zeros(reach + 1)
    count = 0
    for u, e in zip(_centred(inputs), _centred(residuals), strict=True):
        cross += _lagged(u, e, before, after)
        colour_e += _lagged(e, e, 0, reach)
        colour_u += _lagged(u, u, 0, reach)
        count += e.size
    power = float(np.sqrt(colour_e[0] * colour_u[0]))
    if power <= 0.0:
        return np.zeros_like(cross), 1.0
    # The lagged sums already taper to zero at the ends: Bartlett's window.
    product = (colour_e / colour_e[0]) * (colour_u / colour_u[0])
    spread = max(float(product[0] + 2.0 * np.sum(product[1:])), 1.0)
    return cross / power, LJUNG * float(np.sqrt(spread / count))


def spectrum(parts: Sequence[Array], period: float, window: float = 8.0) -> tuple[Array, Array]:
    """Return (frequencies in Hz, amplitude density in unit/sqrt(Hz)), by Welch over *window* s."""
    size = _window(parts, period, window)
    total, count = np.zeros(size // 2 + 1), 0
    for part in parts:
        if part.size >= size:
            total += part.size * welch(part, 1.0 / period, nperseg=size)[1]
            count += part.size
    density: Array = np.sqrt(total[1:] / max(count, 1))
    return _even_frequencies(size, period), density


def coherence(
    inputs: Sequence[Array], residuals: Sequence[Array], period: float, window: float = 4.0
) -> tuple[Array, Array, float]:
    """Return (f in Hz, coherence of residual and input, its 95 % level for unrelated signals).

    The level is 1 - 0.05^(1/(L - 1)) with L independent windows, and 1 with at most one. Windows
    last *window* s, or less where these are fewer than 8.
    """
    size = _window(residuals, period, window)
    while size > SHORTEST and _windows(residuals, size) < COHERENCE_WINDOWS:
        size = max(SHORTEST, round(0.8 * size))
    n = size // 2 + 1
    both = np.zeros(n, dtype=complex)
    power_u, power_e = np.zeros(n), np.zeros(n)
    for u, e in zip(inputs, residuals, strict=True):
        if e.size < size:
            continue
        both += e.size * csd(u, e, 1.0 / period, nperseg=size)[1]
        power_u += e.size * welch(u, 1.0 / period, nperseg=size)[1]
        power_e += e.size * welch(e, 1.0 / period, nperseg=size)[1]
    windows = _windows(residuals, size)
    level = 1.0 - 0.05 ** (1.0 / (windows - 1.0)) if windows > 1.0 else 1.0
    with np.errstate(divide='ignore', invalid='ignore'):
        found = np.asarray(np.abs(both) ** 2 / (power_u * power_e), dtype=np.float64)
    return _even_frequencies(size, period), np.nan_to_num(found[1:]), level


def noise_density(sigma: float, rho: float, sampling: float, f: Array) -> Array:
    """Return the amplitude density of AR(1) noise sampled every *sampling* s, at f in Hz."""
    power = 2.0 * sampling * sigma**2 * (1.0 - rho**2)
    return np.asarray(
        np.sqrt(power / (1.0 + rho**2 - 2.0 * rho * np.cos(2.0 * np.pi * f * sampling)))
    )


def _even_frequencies(size: int, period: float) -> Array:
    return np.asarray(np.fft.rfftfreq(size, period)[1:], dtype=np.float64)


def _centred(parts: Sequence[Array]) -> list[Array]:
    mean = float(np.mean(np.concatenate(parts))) if parts else 0.0
    return [part - mean for part in parts]


def _lagged(a: Array, b: Array, before: int, after: int) -> Array:
    """Return sums of a(t) b(t + lag) at lags -before..after, zero beyond the ends."""
    full = correlate(b, a, mode='full', method='fft')
    zero = a.size - 1
    low, high = min(before, a.size - 1), min(after, b.size - 1)
    out = np.zeros(before + after + 1)
    out[before - low : before + high + 1] = full[zero - low : zero + high + 1]
    return out


def _window(parts: Sequence[Array], period: float, window: float) -> int:
    longest = max(part.size for part in parts)
    return max(SHORTEST, min(round(window / period), longest))


def _windows(parts: Sequence[Array], size: int) -> float:
    """Return how many windows of *size* samples the parts that are long enough contain."""
    return sum(part.size / size for part in parts if part.size >= size)
