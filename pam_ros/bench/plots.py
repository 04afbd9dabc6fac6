# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The plots of trials for the page of a bench: one column for each controller, on equal axes."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from pam_ros.bench.trial import Trial
from pam_ros.identification.wording import Scale, scale_for
from pam_ros.report import style

Array = NDArray[np.float64]
HEIGHTS = (120, 90, 90)  # px: position, error, pressure
KILO = 1e-3  # kPa in a Pa
COLUMNS = 2 * style.NARROW  # points in which a curve is thinned
# Of the errors, the largest shares that may leave the axis: a jump of the reference is an error.
MOST_ERRORS = 0.97
ROOM = 1.15  # height of an axis above what it must show
OUTAGE = '#e6d3d9'  # the background of outages
MUSCLES = (style.COLOURS[2], style.COLOURS[0], style.COLOURS[1], style.NOISE)


@dataclass(frozen=True)
class TrialPicture:
    """The plot of a *controller*'s trial as SVG."""

    controller: str
    svg: str


def pictures(name: str, trials: Mapping[str, Trial]) -> list[TrialPicture]:
    """Return the plots of the *trials* of a scenario, by the names of the controllers.

    *name* begins the ids of the plots, and is a word. Positions are relative to the start, where
    they all are equal; the axes are the same in all plots.
    """
    if not trials:
        return []
    scale = scale_for('rad' if next(iter(trials.values())).is_revolute else 'm', 1.0)
    extents = _extents(trials, scale)
    found = []
    for k, (controller, trial) in enumerate(trials.items()):
        with style.styled():
            figure, axes = style.stacked(style.NARROW, HEIGHTS)
            _draw(axes, trial, scale)
            for ax, (low, high) in zip(axes, extents, strict=True):
                ax.set_ylim(low, high)
            text = f'position, error and commanded pressure of {controller} over time'
            found.append(TrialPicture(controller, style.svg(figure, f'{name}-{k}', text)))
    return found


def _draw(axes: list[Axes], trial: Trial, scale: Scale) -> None:
    position, error, pressure = axes
    start = trial.reference[0]
    _line(position, trial.t, scale.factor * (trial.reference - start), style.MEASURED, 3.0)
    _line(position, trial.t, scale.factor * (trial.position - start), MUSCLES[0])
    _line(error, trial.t, scale.factor * trial.error, MUSCLES[0])
    for k, column in enumerate(trial.pressure.T):
        _line(pressure, trial.t, KILO * column, MUSCLES[k % len(MUSCLES)])
    end = float(trial.t[-1])
    for begin, back in trial.outages.tolist():
        for ax in axes:
            ax.axvspan(begin, min(back, end), color=OUTAGE, linewidth=0.0, zorder=0)
    for change in trial.changes.tolist():
        for ax in axes:
            ax.axvline(change, color=style.SINCE, linewidth=1.0, linestyle=(0, (4, 2)))
    position.set_title(f'position from the start [{scale.unit}]')
    error.set_title(f'error [{scale.unit}]')
    pressure.set_title('commanded pressure [kPa]')
    pressure.set_xlabel('time [s]')
    pressure.set_xlim(0.0, end)


def _line(ax: Axes, t: Array, values: Array, colour: str, width: float = 1.2) -> None:
    ax.plot(*style.envelope(t, values, COLUMNS), color=colour, linewidth=width)


def _extents(trials: Mapping[str, Trial], scale: Scale) -> list[tuple[float, float]]:
    """Return the limits of the three axes: what all controllers need, without rare errors."""
    positions, errors, pressures = [], [], []
    for trial in trials.values():
        for values in (trial.reference, trial.position):
            moved = scale.factor * (values - trial.reference[0])
            positions += [float(moved.min()), float(moved.max())]
        errors.append(scale.factor * float(np.quantile(np.abs(trial.error), MOST_ERRORS)))
        low, high = KILO * trial.limits.min(), KILO * trial.limits.max()
        sent = np.clip(KILO * trial.pressure, low, high)
        pressures += [float(np.nanmin(sent)), float(np.nanmax(sent))]
    error = ROOM * max(*errors, 1e-6 * scale.factor)
    return [_with_room(positions), (-error, error), _with_room(pressures)]


def _with_room(values: list[float]) -> tuple[float, float]:
    low, high = min(values), max(values)
    room = 0.5 * (ROOM - 1.0) * max(high - low, 1e-3 * max(abs(low), abs(high)), 1e-9)
    return low - room, high + room
