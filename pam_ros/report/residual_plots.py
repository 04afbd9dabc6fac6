# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Plots of the residual: its correlations and spectrum, and the residual over other signals."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from pam_ros.identification.data.noise import Noise
from pam_ros.identification.wording import Scale
from pam_ros.report import diagnostics, style
from pam_ros.report.runs import Run
from pam_ros.report.time_plots import Curve, Stretch

Array = NDArray[np.float64]
Pick = Callable[[Run], Array]

FINE, COARSE = 0.01, 0.04  # s between values, for autocorrelation and cross-correlation
LAGS = 2.0  # s
SLOW = 0.02  # s
BINS = 36
LOOP_SPANS = (5.0, 10.0, 20.0)  # s
LOOP_JUMP = 0.1  # s
STILL = 0.005  # of the input's range per second; slower is neither rising nor falling
FEWEST = 12  # fewest samples of a bin that is drawn


def autocorrelation(runs: list[Run], curves: list[Curve]) -> Figure:
    """Return the residuals' autocorrelation, with the band of white noise."""
    figure, ax = style.panel()
    period = _period(runs, FINE)
    lags = min(round(LAGS / period), *(run.t.size for run in runs))
    band = 0.0
    for curve in curves:
        found, band = diagnostics.autocorrelation(_thinned(runs, curve.stage, period), lags)
        ax.plot(period * np.arange(lags + 1), found, **curve.look)
    ax.axhspan(-band, band, color=style.NOISE, alpha=0.16, linewidth=0.0)
    ax.set_ylim(-1.05, 1.05)
    ax.set_title('correlation')
    ax.set_xlabel('lag, s')
    return figure


def cross_correlation(runs: list[Run], curves: list[Curve]) -> Figure:
    """Return the correlation of residual and input, with Ljung's band of the last curve."""
    figure, ax = style.panel()
    period = _period(runs, COARSE)
    after = round(LAGS / period)
    before = after // 2
    inputs = [diagnostics.resampled(run.t, run.drive, period) for run in runs]
    band, top = 1.0, 0.0
    for curve in curves:
        found, band = diagnostics.cross_correlation(
            inputs, _thinned(runs, curve.stage, period), before, after
        )
        top = max(top, float(np.max(np.abs(found))))
        lags = period * np.arange(-before, after + 1)
        ax.plot(lags, found, **curve.look)
    ax.axhspan(-band, band, color=style.NOISE, alpha=0.16, linewidth=0.0)
    reach = 1.15 * max(top, min(band, 1.0))
    ax.set_ylim(-reach, reach)
    ax.set_title('correlation')
    ax.set_xlabel('lag of the residual after the input, s')
    return figure


def spectrum(runs: list[Run], curves: list[Curve], scale: Scale, noise: Noise) -> Figure:
    """Return the residuals' amplitude density, next to that of the noise alone."""
    figure, ax = style.panel()
    period = _sampling(runs)
    f = np.array([1.0])
    for curve in curves:
        parts = [diagnostics.resampled(r.t, r.residual(curve.stage), period) for r in runs]
        f, density = diagnostics.spectrum(parts, period)
        ax.plot(*_log_thinned(f, scale.factor * density), **curve.look)
    if noise.sigma > 0.0:
        floor = scale.factor * diagnostics.noise_density(noise.sigma, noise.rho, period, f)
        ax.plot(f, floor, **style.NOISE_LINE)
    ax.set_xscale('log')
    ax.set_yscale('log')
    style.log_axis(ax.xaxis)
    style.log_axis(ax.yaxis)
    ax.set_title(f'{scale.unit}/√Hz')
    ax.set_xlabel('frequency, Hz')
    return figure


def coherence(runs: list[Run], curves: list[Curve]) -> Figure:
    """Return the coherence of residual and input, with the level of unrelated signals."""
    figure, ax = style.panel()
    period = _period(runs, SLOW)
    inputs = [diagnostics.resampled(run.t, run.drive, period) for run in runs]
    level = 1.0
    for curve in curves:
        f, found, level = diagnostics.coherence(
            inputs, _thinned(runs, curve.stage, period), period
        )
        ax.plot(*_log_thinned(f, found), **curve.look)
    ax.axhspan(0.0, level, color=style.NOISE, alpha=0.16, linewidth=0.0)
    ax.axhline(level, color=style.NOISE, linewidth=1.0)  # visible where the band is low
    ax.set_xscale('log')
    style.log_axis(ax.xaxis)
    ax.set_ylim(0.0, 1.05)
    ax.set_title('coherence')
    ax.set_xlabel('frequency, Hz')
    return figure


def against(runs: list[Run], curves: list[Curve], scale: Scale, pick: Pick, label: str) -> Figure:
    """Return the residuals over a signal: mean and the middle 80 % in bins of equal count."""
    figure, ax = style.panel()
    x = np.concatenate([pick(run) for run in runs])
    for curve in curves:
        e = scale.factor * np.concatenate([run.residual(curve.stage) for run in runs])
        at, mean, low, high = binned(x, e)
        colour = style.COLOURS[curve.stage]
        ax.fill_between(at, low, high, color=colour, alpha=0.16, linewidth=0.0)
        ax.plot(at, mean, **curve.look)
    ax.axhline(0.0, color=style.FAINT, linewidth=0.7)
    ax.set_title(f'residual, {scale.unit}')
    ax.set_xlabel(label)
    return figure


def by_direction(
    runs: list[Run], curves: list[Curve], scale: Scale, pressure: Scale, label: str
) -> Figure:
    """Return the residuals over rising and over falling input, which shows loops."""
    figure, ax = style.panel()
    period = _period(runs, COARSE)
    p = [diagnostics.resampled(run.t, run.drive, period) for run in runs]
    slope = np.concatenate([np.gradient(part, period) for part in p])
    x = pressure.factor * np.concatenate(p)
    still = STILL * float(np.ptp(x)) / pressure.factor
    for curve in curves:
        e = scale.factor * np.concatenate(_thinned(runs, curve.stage, period))
        for is_rising, marker in ((True, '^'), (False, 'v')):
            chosen = slope > still if is_rising else slope < -still
            if np.count_nonzero(chosen) < 2 * FEWEST:
                continue
            at, mean, _, _ = binned(x[chosen], e[chosen], BINS // 2)
            face = curve.look['color'] if is_rising else 'white'
            ax.plot(at, mean, **curve.look, marker=marker, markerfacecolor=face, markersize=5)
    ax.axhline(0.0, color=style.FAINT, linewidth=0.7)
    ax.set_title(f'residual, {scale.unit}')
    ax.set_xlabel(label)
    return figure


def loop(
    stretch: Stretch, curves: list[Curve], scale: Scale, pressure: Scale, quantity: str, label: str
) -> Figure:
    """Return the measured and the simulated signal over the input, for one stretch."""
    figure, ax = style.panel()
    run, part = stretch.run, slice(stretch.start, stretch.stop)
    t = run.t[part]
    period = float(t[-1] - t[0]) / 700.0
    p = pressure.factor * diagnostics.resampled(t, run.drive[part], period)
    y = scale.factor * diagnostics.resampled(t, run.target[part], period)
    ax.plot(p, y, color=style.MEASURED, linewidth=3.0)
    for curve in curves:
        y = scale.factor * diagnostics.resampled(t, run.simulated[curve.stage][part], period)
        ax.plot(p, y, **curve.look)
    ax.set_title(f'{quantity}, {scale.unit}')
    ax.set_xlabel(label)
    return figure


def loop_stretch(runs: list[Run]) -> Stretch:
    """Return the stretch with the widest loop of the input, with few reversals and no jumps."""
    best, most = Stretch(runs[0], 0, runs[0].t.size), -np.inf
    for run in runs:
        path = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(run.drive)))])
        soon = np.searchsorted(run.t, run.t + LOOP_JUMP).clip(max=run.t.size - 1)
        leap = np.abs(run.drive[soon] - run.drive)
        total = float(run.t[-1] - run.t[0])
        for span in (min(seconds, total) for seconds in LOOP_SPANS):
            for start in np.arange(run.t[0], run.t[-1] - span + 1e-9, span / 6.0):
                i, j = np.searchsorted(run.t, (start, start + span + 1e-9)).tolist()
                reach = float(np.ptp(run.drive[i:j])) if j - i > FEWEST else 0.0
                if reach <= 0.0:
                    continue
                # The path of a full loop is twice the range of the input: a longer path contains
                # more reversals, a shorter one is not a full loop.
                turns = float(path[j - 1] - path[i]) / reach
                jumps = min(float(np.max(leap[i:j])) / reach, 1.0)
                worth = reach * min(turns, 2.0) / max(turns, 2.0) * (1.0 - jumps) ** 2
                if worth > most:
                    best, most = Stretch(run, i, j), worth
    return best


def binned(x: Array, e: Array, bins: int = BINS) -> tuple[Array, Array, Array, Array]:
    """Return (centre, mean, 10 % and 90 % quantile) of e in bins of x with equal counts.

    Values of x that occur more often than the count of a bin get a bin of their own.
    """
    order = np.argsort(x, kind='stable')
    x, e = x[order], e[order]
    edges = np.unique(x[np.linspace(0, x.size - 1, bins + 1).astype(int)])
    at = np.concatenate([[0], np.searchsorted(x, edges, side='right')])
    rows = []
    for i, j in pairwise(at.tolist()):
        if j - i >= FEWEST:
            low, high = np.quantile(e[i:j], (0.1, 0.9))
            rows.append((x[i:j].mean(), e[i:j].mean(), low, high))
    if not rows:
        rows = [(x.mean(), e.mean(), *np.quantile(e, (0.1, 0.9)))]
    a, b, c, d = np.array(rows).T
    return a, b, c, d


def _sampling(runs: list[Run]) -> float:
    return float(np.median([np.median(np.diff(run.t)) for run in runs]))


def _period(runs: list[Run], wanted: float) -> float:
    own = _sampling(runs)
    return own * max(1, round(wanted / own))


def _thinned(runs: list[Run], stage: int, period: float) -> list[Array]:
    return [diagnostics.resampled(run.t, run.residual(stage), period) for run in runs]


def _log_thinned(f: Array, values: Array, points: int = 260) -> tuple[Array, Array]:
    """Return a spectrum with its root mean square in *points* equal steps of log f."""
    if f.size <= points:
        return f, values
    cell = np.unique(np.searchsorted(f, np.geomspace(f[0], f[-1], points), side='left'))
    cell = cell[cell < f.size]
    count = np.diff(np.append(cell, f.size))
    mean = np.add.reduceat(values**2, cell) / count
    return np.add.reduceat(f, cell) / count, np.sqrt(mean)
