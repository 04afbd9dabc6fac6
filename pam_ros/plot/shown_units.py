# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The units in which plots are shown: mm, deg and kPa, or SI as on the topics."""

from collections.abc import Sequence
from dataclasses import replace
from math import pi
from typing import NamedTuple

from pam_ros.plot.panels import Panel

SI = 'SI'
# What can be chosen by the unit of the positions; the first is what is shown at first. If the unit
# of positions is not known, the choice says what it is.
_CHOICES = {
    '': ('kPa', SI),
    'm': ('mm, kPa', SI),
    'rad': ('deg, kPa', SI),
    'm or rad': ('kPa', 'mm, kPa', 'deg, kPa', SI),
}


class Scale(NamedTuple):
    """A unit, its number in one SI unit, and how it is written in the name of a column."""

    unit: str
    factor: float
    suffix: str


_LENGTH = Scale('mm', 1e3, 'mm')
_ANGLE = Scale('deg', 180.0 / pi, 'deg')
_PRESSURE = Scale('kPa', 1e-3, 'kPa')
_SUFFIXES = {
    'm or rad': '',
    'fraction of the length': 'fraction',
    'N or N·m': 'N_or_Nm',
    'N·m': 'Nm',
    'N/m': 'N_per_m',
    'N·s/m': 'Ns_per_m',
}


def choices(panels: Sequence[Panel]) -> tuple[str, ...]:
    """Return the names of the units in which *panels* can be shown, the usual one first."""
    units = [_si(panel) for panel in panels if panel.quantity == 'position']
    return _CHOICES[units[0] if units else '']


def scale(panel: Panel, choice: str) -> Scale:
    """Return the unit of a plot for one of :func:`choices`."""
    si = _si(panel)
    if panel.quantity == 'pressure' and choice != SI:
        return _PRESSURE
    if panel.quantity == 'position' and si != 'rad' and choice.startswith('mm'):
        return _LENGTH
    if panel.quantity == 'position' and si != 'm' and choice.startswith('deg'):
        return _ANGLE
    return Scale(si, 1.0, _SUFFIXES.get(si, si))


def _si(panel: Panel) -> str:
    return panel.title.rpartition(', ')[2]


def label(panel: Panel) -> str:
    """Return the title of a plot without its unit."""
    return panel.title.rpartition(', ')[0]


def in_units(panel: Panel, choice: str) -> Panel:
    """Return a plot with its values and its title in the units of *choice*."""
    unit, factor, _ = scale(panel, choice)
    lines = [replace(line, value=factor * line.value) for line in panel.lines]
    return replace(panel, title=f'{label(panel)}, {unit}', lines=lines)
