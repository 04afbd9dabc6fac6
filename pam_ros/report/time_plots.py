# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Plots over time: measured and simulated with the residual below, and the errors."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from pam_ros.identification.wording import Scale
from pam_ros.report import style
from pam_ros.report.diagnostics import Size
from pam_ros.report.runs import Run

Array = NDArray[np.float64]

CLOSE_UP = 6.0  # s
BETWEEN = 0.01  # share of the whole time that separates two runs in the overview


@dataclass(frozen=True)
class Curve:
    """A model to be drawn: its stage, its name, and its line style."""

    stage: int
    label: str

    @property
    def look(self) -> dict[str, Any]:
        """Return colour and line style as arguments of matplotlib."""
        return {'color': style.COLOURS[self.stage], 'linestyle': style.DASHES[self.stage]}


@dataclass(frozen=True)
class Stretch:
    """A part of a run: samples start..stop-1, drawn *shift* s later than its own stamps."""

    run: Run
    start: int
    stop: int
    shift: float = 0.0

    @property
    def begins_at(self) -> float | None:
        """The time in the drawing at which effects begin to act, None if not in this part."""
        t, since = self.run.t[self.start : self.stop], self.run.since
        return since + self.shift if since is not None and t[0] <= since <= t[-1] else None


def whole(runs: list[Run]) -> list[Stretch]:
    """Return all runs side by side, each after the one before."""
    total = sum(float(run.t[-1] - run.t[0]) for run in runs)
    found, end = [], 0.0
    for run in runs:
        found.append(Stretch(run, 0, run.t.size, end - float(run.t[0])))
        end += float(run.t[-1] - run.t[0]) + BETWEEN * total
    return found


def close_up(runs: list[Run], before: int, after: int) -> Stretch:
    """Return the few seconds, preferably held out, with the greatest gain between two stages."""
    best, most = Stretch(runs[0], 0, runs[0].t.size), (False, -np.inf)
    for run in runs:
        span = min(CLOSE_UP, float(run.t[-1] - run.t[0]))
        gain = run.residual(before) ** 2 - run.residual(after) ** 2
        integral = np.concatenate([[0.0], np.cumsum(gain * np.gradient(run.t))])
        kept = np.concatenate([[0.0], np.cumsum(run.held * np.gradient(run.t))])
        starts = np.searchsorted(run.t, np.arange(run.t[0], run.t[-1] - span + 1e-9, span / 4.0))
        for start in starts.tolist():
            stop = int(np.searchsorted(run.t, run.t[start] + span, side='right'))
            is_kept = float(kept[stop] - kept[start]) > 0.5 * span
            worth = (is_kept, float(integral[stop] - integral[start]))
            if worth > most:
                best, most = Stretch(run, start, stop), worth
    return best


def measured_and_simulated(
    stretches: list[Stretch], curves: list[Curve], scale: Scale, quantity: str, noise: float,
    width: int,
) -> Figure:  # fmt: skip
    """Return the measured and simulated signals over time, with the residuals below.

    The residual of the last model is drawn again alone, since those of the models before it may
    be far larger. Samples that were not fitted have a tinted background. The band is two
    standard deviations of the *noise* on each side. If effects begin to act at some time, a line
    is drawn there.
    """
    heights = (220, 100, 90) if width > 600 else (180, 100, 90)
    figure, (above, below, alone) = style.stacked(width, heights)
    last = curves[-1]
    share = [s.run.t[s.stop - 1] - s.run.t[s.start] for s in stretches]
    columns = [max(20, int((width - 70) * x / sum(share) * 0.9)) for x in share]
    for stretch, n in zip(stretches, columns, strict=True):
        part = slice(stretch.start, stretch.stop)
        t = stretch.run.t[part] + stretch.shift
        for ax in figure.axes:
            _tint(ax, t, stretch.run.held[part])
            if stretch.begins_at is not None:
                ax.axvline(stretch.begins_at, color=style.SINCE, linewidth=1.2)
        y = scale.factor * stretch.run.target[part]
        above.plot(*style.envelope(t, y, n), color=style.MEASURED, linewidth=3.0)
        for curve in curves:
            y = scale.factor * stretch.run.simulated[curve.stage][part]
            above.plot(*style.envelope(t, y, n), **curve.look)
            e = scale.factor * stretch.run.residual(curve.stage)[part]
            below.plot(*style.envelope(t, e, n), **curve.look)
            if curve is last:
                alone.plot(*style.envelope(t, e, n), **curve.look)
    for ax in figure.axes:
        for a, b in pairwise(stretches):
            middle = 0.5 * (a.run.t[a.stop - 1] + a.shift + b.run.t[b.start] + b.shift)
            ax.axvline(middle, color=style.FAINT, linewidth=0.6)
    alone.axhspan(-2.0 * noise * scale.factor, 2.0 * noise * scale.factor, **_BAND)
    above.margins(x=0.0)
    above.set_title(f'{quantity}, {scale.unit}')
    below.set_title(f'residual (measured − simulated), {scale.unit}')
    alone.set_title(f'residual, {last.label}, {scale.unit}')
    alone.set_xlabel('time, s')
    return figure


_BAND: dict[str, Any] = {'color': style.NOISE, 'alpha': 0.16, 'linewidth': 0.0}


def _tint(ax: Axes, t: Array, held: NDArray[np.bool_]) -> None:
    if held.all():
        return  # all samples of this stretch are held out
    edges = np.flatnonzero(np.diff(np.concatenate([[0], held.astype(int), [0]])))
    for start, stop in edges.reshape(-1, 2):
        ax.axvspan(t[start], t[stop - 1], color=style.HELD_OUT, linewidth=0.0, zorder=0)


def errors(
    sizes: list[tuple[Curve, Size, Size]], noise: float, scale: Scale, width: int
) -> Figure:
    """Return the RMSE of each model, fitted and held out, with its interval and the noise.

    The name of each model stands above its row.
    """
    height = 48 * len(sizes)
    figure, (ax,) = style.stacked(width, (height,))
    reached = []
    for row, (curve, fit, held) in enumerate(sizes):
        y = len(sizes) - 1 - row
        ax.text(
            0.0, y + 0.34, curve.label, transform=ax.get_yaxis_transform(),
            color=style.INK, va='center', zorder=3,
            bbox={'facecolor': 'white', 'edgecolor': 'none', 'alpha': 0.85, 'pad': 1.0},
        )  # fmt: skip
        for size, offset, filled in ((fit, 0.06, False), (held, -0.2, True)):
            if not np.isfinite(size.rmse) or size.rmse <= 0.0:
                continue
            low, x, high = (scale.factor * v for v in (size.low, size.rmse, size.high))
            reached += [x, high]
            look = style.COLOURS[curve.stage]
            ax.plot([max(low, 1e-3 * x), high], [y + offset] * 2, color=look, linewidth=1.4)
            ax.plot(
                x, y + offset, 'o', color=look, markersize=7,
                markerfacecolor=look if filled else 'white',
            )  # fmt: skip
    if noise > 0.0:
        reached.append(scale.factor * noise)
        ax.axvline(scale.factor * noise, **style.NOISE_LINE)
    ax.set_ylim(-0.45, len(sizes) - 0.45)
    ax.set_yticks([])
    ax.spines['left'].set_visible(False)
    if reached:
        ax.set_xscale('log')
        ax.set_xlim(0.7 * min(reached), 1.4 * max(reached))
        style.log_axis(ax.xaxis)
    ax.set_xlabel(f'RMSE, {scale.unit}')
    return figure
