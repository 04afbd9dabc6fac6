# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A thinned copy of the runs, on which many models are compared before a few are fitted in full.

Samples are thinned to the stride that the rig's own frequency allows. Commands that vary a
little within a stride are replaced by their mean, which has the same effect on the load. A jump
keeps its stamp, because a delay of half a stride would be visible above the noise. A ramp has more
than one mean in a long stride, because valves and hystereses respond differently to large steps.
"""

from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.segment import (
    CommandedSegment,
    HeldSegment,
    PressureSegment,
    Segment,
)
from pam_ros.rig import statics
from pam_ros.rig.equilibrium import rest_position
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]
Indices = NDArray[np.int_]

PHASE = 0.5  # rad of the rig's fastest oscillation in one period
PERIODS = (1e-3, 10e-3)  # s, shortest period, and the longest one unless there are many samples
LONGEST_PERIOD = 50e-3  # s, longest period: commands that change fast keep shorter steps
JUMP = 0.01  # change of a command that is a jump, as a share of its range
LEAP = 0.05  # change of a measured pressure over a stride that is a jump, as a share of its range
RAMP = 0.003  # change of a command over a long stride that is a ramp, as a share of its range
ROUNDING = 1e-9  # largest change by the rounding of means, as a share of a command's range
ROOM = 0.1  # share by which a period may be longer than desired, since stamps jitter
HELD_STEP = 0.02  # s; at a prescribed length there are no dynamics to resolve, only memories


def coarse_period(model: Joint, longest: float = PERIODS[1]) -> float:
    """Return a period in s of PHASE rad of the oscillation about the stiffest rest position.

    It is at most *longest* s. A load without a spring has no such oscillation.
    """
    periods = PERIODS[0], longest
    if model.is_driven:
        return PERIODS[1]
    if len(model.muscles) > 1 or model.is_revolute:
        return float(np.clip(PHASE / np.sqrt(_stiffest(model) / model.inertia), *periods))
    muscle = model.muscle
    ends = (0.0, muscle.p_max)
    k = max(float(muscle.stiffness(p, rest_position(model, p) / muscle.l0)) for p in ends)
    return float(np.clip(PHASE / np.sqrt(k / model.load.mass), *periods))


def _stiffest(joint: Joint) -> float:
    """Return the largest stiffness in N/m or N m/rad at rest, with 0 or p_max in each muscle."""
    found = []
    for p in product(*((0.0, muscle.p_max) for muscle in joint.muscles)):
        s = statics.equilibrium(joint, p)
        found.append(statics.stiffness(joint, p, s) + statics.weight_stiffness(joint, s))
    return float(max(found))


def longest_step(period: float) -> float:
    """Return the longest step in s of simulations of segments that are thinned to *period* s.

    A period that is longer than desired remains one step: two would cost twice as much.
    """
    return (1.0 + ROOM) * period


def thinned(segment: Segment, longest: float) -> Segment:
    """Return *segment* with every n-th sample.

    The period is at most about *longest* in s, and at a prescribed length at most about HELD_STEP.
    """
    period = float(np.median(np.diff(segment.t)))
    if isinstance(segment, HeldSegment):
        stride = max(1, int(HELD_STEP / period + ROOM))
        return replace(
            segment,
            **{
                name: getattr(segment, name)[::stride]
                for name in ('t', 'target', 'fit', 'pressure', 'position', 'velocity')
            },
        )
    assert isinstance(segment, CommandedSegment)
    rows = np.arange(0, segment.t.size, max(1, int(longest / period + ROOM)))
    if isinstance(segment, PressureSegment):
        rows = _with_jumps(rows, segment.target)
    t = segment.t[rows]
    drive_t, drive = segment.drive_t, segment.drive
    drive_t, drive = _changed(*_merged(drive_t, drive, _divided(drive_t, drive, t)))
    return replace(
        segment,
        t=t,
        target=segment.target[rows],
        fit=segment.fit[rows],
        drive_t=drive_t,
        drive=drive,
    )


def _with_jumps(rows: Indices, target: Array) -> Indices:
    """Return *rows* (m,) with all rows between two of them where *target* (n,) jumps.

    When a pressure without a lag jumps is known to a sampling period, and tells a dead time from a
    lag. With the thinned samples alone, delays that differ by a stride would fit as well.
    """
    jumps = np.abs(np.diff(target[rows])) > LEAP * np.ptp(target)
    starts, ends = rows[:-1][jumps], rows[1:][jumps]
    between = [np.arange(start, end) for start, end in zip(starts, ends, strict=True)]
    return np.unique(np.concatenate([rows, *between]))


def _divided(at: Array, u: Array, t: Array) -> Array:
    """Return the edges of the intervals in which one mean stands for the commands.

    at (m,), u (m, muscles), t (n,) are the stamps and values of commands, and the samples' stamps.
    The intervals are those between samples. Where a command changes by more than RAMP of its
    range, they are divided into equal ones of at least PERIODS[1].
    """
    held = u[np.clip(np.searchsorted(at, t, side='right') - 1, 0, at.size - 1)]
    changes = (np.abs(np.diff(held, axis=0)) > RAMP * np.ptp(u, axis=0)).any(axis=1)
    span = np.diff(t)
    room = np.maximum(1.0, np.floor(span / PERIODS[1] + ROOM))
    parts = np.where(changes, room, 1.0).astype(int)
    number = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    edges = np.repeat(t[:-1], parts) + number * np.repeat(span / parts, parts)
    return np.append(edges, t[-1])


def _merged(at: Array, u: Array, t: Array) -> tuple[Array, Array]:
    """Return commands with one mean per interval if they vary little within it.

    at (m,), u (m, muscles) are the stamps and values of commands, t (n,) the intervals' edges.
    """
    if at.size < 2 or at.size <= t.size:
        return at, u
    # Time-weighted mean over each interval of the command with a zero-order hold, by its integral,
    # and its moment about the interval's middle.
    i = np.clip(np.searchsorted(at, t, side='right') - 1, 0, at.size - 1)
    integral, first = _sums(u, np.diff(at)), _sums(u, np.diff(0.5 * (at - t[0]) ** 2))
    impulse = np.diff(integral[i] + u[i] * _column(t - at[i]), axis=0)
    middle = _column(0.5 * (t[1:] + t[:-1]) - t[0])
    arms = first[i] + 0.5 * u[i] * _column((t - t[0]) ** 2 - (at[i] - t[0]) ** 2)
    span = _column(np.diff(t))
    mean, moment = impulse / span, np.diff(arms, axis=0) - middle * impulse
    cell = np.searchsorted(t, at, side='right') - 1
    inside = (cell >= 0) & (cell < len(mean))
    jump = np.zeros(len(mean), dtype=bool)
    leaps = (np.abs(np.diff(u, axis=0)) > JUMP * np.ptp(u, axis=0)).any(axis=1)
    large = np.flatnonzero(leaps) + 1
    jump[cell[large][inside[large]]] = True
    # A constant mean has no moment. The moment is given to the adjacent intervals, with opposite
    # signs, since otherwise fast waves would be too small. An interval with a jump keeps its own
    # commands, and takes none.
    mixed = jump[2:] | jump[1:-1] | jump[:-2]
    given = moment[1:-1] / (middle[2:] - middle[:-2])
    given[mixed] = 0.0
    mean[2:] += given / span[2:]
    mean[:-2] -= given / span[:-2]
    keep = ~inside | jump[np.clip(cell, 0, len(mean) - 1)]
    # An interval that keeps its own commands starts with the command at its first stamp.
    cells = np.flatnonzero(~jump)
    firsts = t[:-1][jump]
    held = u[np.clip(np.searchsorted(at, firsts, side='right') - 1, 0, None)]
    stamps = np.concatenate([at[keep], t[cells], firsts])
    values = np.concatenate([u[keep], mean[cells], held])
    order = np.argsort(stamps, kind='stable')
    stamps, values = stamps[order], values[order]
    once = np.concatenate([stamps[1:] > stamps[:-1], [True]])
    return stamps[once], values[once]


def _changed(at: Array, u: Array) -> tuple[Array, Array]:
    """Return the commands u (m, muscles) with the stamps at (m,) that differ from the one before.

    The others have no influence, but a simulation ends a step at each command: with a dead time,
    their stamps are between the samples, and there would be twice as many steps.
    """
    changes = np.abs(np.diff(u, axis=0)) > ROUNDING * np.ptp(u, axis=0)
    kept = np.append(0, 1 + np.flatnonzero(changes.any(axis=1)))
    return at[kept], u[kept]


def _sums(u: Array, widths: Array) -> Array:
    """Return the cumulative sums, from 0, of commands u (m, muscles) times widths (m - 1,)."""
    steps = np.cumsum(u[:-1] * _column(widths), axis=0)
    return np.concatenate([np.zeros((1, u.shape[1])), steps])


def _column(values: Array) -> Array:
    """Return *values* (n,) as a column (n, 1), to be multiplied by the values of each muscle."""
    return values[:, None]
