# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Plots one below the other on a common axis of time: their titles, lines and names."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.plot.colours import GREY
from pam_ros.plot.column_names import column_name
from pam_ros.plot.topics import TOPICS, Key
from pam_ros.recording.outliers import LONGEST, MOST

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

UNITS = ('m', 'rad')
_EFFORT = {'m': 'N', 'rad': 'N·m', '': 'N or N·m'}
# A pause is drawn as a gap if it is longer than this many sampling periods, and than this in s.
GAP_PERIODS, GAP_SECONDS = 10.0, 0.5


class Curves(NamedTuple):
    """Curves by their keys, stamps in s and values in SI, both (n,), and the muscles' names.

    ``is_outlier`` has the samples of a curve that are outliers (n,), if it was judged.
    """

    samples: Mapping[Key, tuple[Array, Array]]
    muscles: tuple[str, ...] = ()
    is_outlier: Mapping[Key, Mask] = MappingProxyType({})


@dataclass(frozen=True, eq=False)
class PanelLine:
    """A line of a plot: stamps in s and values in SI, both (n,), with NaN in its gaps.

    Lines of the same ``number`` are of the same joint or muscle. A command is constant until the
    next one (``is_held``); a measured signal is drawn linearly between its samples. ``column`` is
    the name of its column in a CSV file without the unit, and ``outliers`` (k,) are the stamps of
    samples that jump away from their neighbours and back.
    """

    name: str
    number: int
    is_set_point: bool
    is_held: bool
    t: Array
    value: Array
    column: str = ''
    outliers: Array = field(default_factory=lambda: np.empty(0))


@dataclass(frozen=True, eq=False)
class Panel:
    """A plot: its title with the unit, its lines, and its quantity; set-points come first."""

    title: str
    lines: list[PanelLine]
    quantity: str = ''


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


def panels(curves: Curves, unit: str, end: float) -> list[Panel]:
    """Return the plots of *curves*, with all of their samples.

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
        lines = [_line(key, curves, measured, end) for key in own]
        made.append(Panel(title, lines, panel))
    return made


def _line(key: Key, curves: Curves, measured: list[str], end: float) -> PanelLine:
    use = TOPICS[key.topic]
    t, value = curves.samples[key]
    outliers = np.empty(0) if use.is_set_point else _outliers(curves, key)
    is_reference = key.topic == 'position_reference'
    if not is_reference:
        t, value = with_gaps(t, value)
    elif t[-1] < end:
        t, value = np.append(t, end), np.append(value, value[-1])
    return PanelLine(
        name_of(key, curves.muscles),
        _number(key, measured),
        use.is_set_point,
        use.is_set_point and key.topic != 'pam_control/state',
        t,
        value,
        column_name(key, curves.muscles, len(measured)),
        outliers,
    )


def _outliers(curves: Curves, key: Key) -> Array:
    """Return the stamps of the outliers of a measured curve; a command acts, however short."""
    t, _ = curves.samples[key]
    found = t[curves.is_outlier[key]] if key in curves.is_outlier else np.empty(0)
    # A signal that has many is like that.
    return found if found.size <= max(MOST * t.size, LONGEST) else np.empty(0)


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


def with_gaps(t: Array, value: Array) -> tuple[Array, Array]:
    """Return a curve with NaN in its gaps: each pause of the samples, and time that goes back."""
    step = np.diff(t)
    limit = max(GAP_PERIODS * float(np.median(step)), GAP_SECONDS) if step.size else np.inf
    cuts = np.flatnonzero((step > limit) | (step < 0.0)) + 1
    return np.insert(t, cuts, t[cuts]), np.insert(value, cuts, np.nan)
