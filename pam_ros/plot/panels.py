# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Plots one below the other on a common axis of time: their titles, lines and names."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.plot.colours import GREY
from pam_ros.plot.topics import TOPICS, Key

Array = NDArray[np.float64]

UNITS = ('m', 'rad')
_EFFORT = {'m': 'N', 'rad': 'N·m', '': 'N or N·m'}
# A pause is drawn as a gap if it is longer than this many sampling periods, and than this in s.
GAP_PERIODS, GAP_SECONDS = 10.0, 0.5


class Curves(NamedTuple):
    """Curves by their keys, stamps in s and values in SI, both (n,), and the muscles' names."""

    samples: Mapping[Key, tuple[Array, Array]]
    muscles: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class PanelLine:
    """A line of a plot: stamps in s and values in SI, both (n,), with NaN in its gaps.

    Lines of the same ``number`` are of the same joint or muscle. A command is constant until the
    next one (``is_held``); a measured signal is drawn linearly between its samples.
    """

    name: str
    number: int
    is_set_point: bool
    is_held: bool
    t: Array
    value: Array


@dataclass(frozen=True, eq=False)
class Panel:
    """A plot: its title with the unit, and its lines; set-points come first."""

    title: str
    lines: list[PanelLine]


def titles(unit: str) -> dict[str, str]:
    """Return the titles of the plots in order; the *unit* of positions is m, rad or unknown."""
    return {
        'position': f'position, {unit or "m or rad"}',
        'contraction': 'contraction, fraction of the length',
        'pressure': 'pressure (gauge), Pa',
        'force': 'force, N',
        'effort': f'effort of the joint, {_EFFORT[unit]}',
        'stiffness': 'stiffness, N/m',
        'damping': 'damping, N·s/m',
    }


def panels(curves: Curves, unit: str, end: float, columns: int | None = None) -> list[Panel]:
    """Return the plots of *curves*, with at most two values in each of *columns* of time.

    A position reference is constant until *end* s. The efforts of ``joint_states`` are drawn if no
    force is published.
    """
    keys = list(curves.samples)
    has_force = any(key.panel == 'force' for key in keys)
    made = []
    for panel, title in titles(unit).items():
        own = [key for key in keys if key.panel == panel]
        if not own or (panel == 'effort' and has_force):
            continue
        measured = [key.column for key in own if not TOPICS[key.topic].is_set_point]
        own.sort(key=_order)
        lines = [_line(key, curves, measured, end, columns) for key in own]
        made.append(Panel(title, lines))
    return made


def _line(
    key: Key, curves: Curves, measured: list[str], end: float, columns: int | None
) -> PanelLine:
    use = TOPICS[key.topic]
    t, value = curves.samples[key]
    is_reference = key.topic == 'position_reference'
    if not is_reference:
        t, value = thinned(t, value, columns)
    elif t[-1] < end:
        t, value = np.append(t, end), np.append(value, value[-1])
    is_held = use.is_set_point and key.topic != 'pam_control/state'
    name = name_of(key, curves.muscles)
    return PanelLine(name, _number(key, measured), use.is_set_point, is_held, t, value)


def _order(key: Key) -> tuple[bool, int, int]:
    """Return the sort key of a line: set-points first, then topics, then muscles."""
    topics = list(TOPICS)
    return not TOPICS[key.topic].is_set_point, topics.index(key.topic), _number(key, [])


def _number(key: Key, measured: list[str]) -> int:
    """Return the index of a muscle, or of a joint among those *measured*."""
    if key.topic == 'position_reference':
        return GREY
    if key.column.isdecimal():
        return int(key.column)
    return measured.index(key.column) if key.column in measured else 0


def name_of(key: Key, muscles: tuple[str, ...]) -> str:
    """Return the name of a line: that of its joint or muscle, or that of its topic."""
    if key.topic == 'pam_control/state':
        return 'reference'
    if not key.column:
        return key.topic
    if key.topic == 'joint_states':
        return key.column
    number = int(key.column)
    name = muscles[number] if number < len(muscles) else f'muscle {number + 1}'
    return f'{name}, commanded' if TOPICS[key.topic].is_set_point else name


def thinned(t: Array, value: Array, columns: int | None) -> tuple[Array, Array]:
    """Return a curve with NaN in its gaps, and at most two values in each of *columns* of time.

    There is a gap at each pause of the samples, and at each step of time backwards.
    """
    step = np.diff(t)
    limit = max(GAP_PERIODS * float(np.median(step)), GAP_SECONDS) if step.size else np.inf
    cuts = np.flatnonzero((step > limit) | (step < 0.0)) + 1
    parts: list[tuple[Array, Array]] = []
    for own_t, own in zip(np.split(t, cuts), np.split(value, cuts), strict=True):
        if parts:
            parts.append((own_t[:1], np.array([np.nan])))
        parts.append((own_t, own) if columns is None else _envelope(own_t, own, columns, t.size))
    return np.concatenate([one for one, _ in parts]), np.concatenate([one for _, one in parts])


def _envelope(t: Array, value: Array, columns: int, size: int) -> tuple[Array, Array]:
    """Return a part of a curve of *size* samples, thinned to its share of *columns*."""
    # It imports matplotlib, which a live page does not need.
    from pam_ros.report.style import envelope

    return envelope(t, value, max(1, round(columns * t.size / size)))
