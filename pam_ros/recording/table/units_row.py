# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A row of units below the names of the columns, as measuring programs write it."""

import re
from collections.abc import Sequence

from pam_ros.errors import RecordingError
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.quantities import QUANTITIES, Target, target_of, unit_in

# Units of signals that a recording does not use.
_OTHERS = {'v', 'mv', 'volt', 'volts', 'a', 'ma', 'ampere', 'hz', '°c', 'degc', 'k', 'w', 'counts'}
_NONE = {'', '-', '--'}
_BRACKETS = re.compile(r'[\[(<{](?P<unit>.*)[\])>}]')
_CLOCK = re.compile(r'[hms:.,0fdyap /-]*[hms]:[hms:.,0fdyap /-]*', re.IGNORECASE)  # hh:mm:ss.000
_LONGEST = 12  # characters of a unit


def is_units(cells: Sequence[str], names: Sequence[str]) -> bool:
    """Return whether *cells* are the units of the columns that *names*, above them, name."""
    filled = [cell for cell in cells if cell not in _NONE]
    if not filled or sum(map(bool, names)) < len(filled):
        return False
    filled = [cell for cell in filled if not _CLOCK.fullmatch(_plain(cell))]
    if any(len(cell) > _LONGEST for cell in filled) or any(map(is_name, filled)):
        return False
    known = sum(bool(_BRACKETS.fullmatch(cell)) or _is_unit(cell) for cell in filled)
    # Where the names above are those of quantities, other words below them are unknown units.
    return 2 * known >= len(filled) or (any(map(is_name, names)) and not any(map(_is_unit, names)))


def with_units(
    name: str, names: Sequence[str], units: Sequence[str], line: str, mapping: ColumnMapping
) -> list[str]:
    """Return the *names* of the columns of the file *name* with the *units* of the row below.

    *line* says where the units are. A name that *mapping* has is kept. Raises RecordingError if
    a name has another unit than the row.
    """
    padded = [*units, *[''] * len(names)][: len(names)]
    return [
        _with_unit(name, *one, line, mapping)
        for one in zip(names, map(_plain, padded), strict=True)
    ]


def _with_unit(name: str, column: str, unit: str, line: str, mapping: ColumnMapping) -> str:
    """Return the name of a *column* with its *unit*."""
    if not column or unit in _NONE or column in mapping or _CLOCK.fullmatch(unit):
        return column
    both = f'{column} [{unit}]'
    own, is_refused = _meaning(column)
    if own is None or not _has_unit(column):
        # A name with an unknown unit of its own is left to the sentence on this unit.
        return column if is_refused and _meaning(both) == (None, False) else both
    other = unit_in(_words(unit), own.quantity)
    same = None if other is None else Target(own.quantity, other)
    if same is None or (same.factor, same.offset) != (own.factor, own.offset):
        raise RecordingError(
            f'{name}: column {column!r} has the unit {unit!r} in {line}, and another one in its '
            f"name: say which is right, such as with --column '{column}={own}'"
        )
    return column


def _meaning(column: str) -> tuple[Target | None, bool]:
    """Return what a name means, and whether it is one whose unit is missing or unknown."""
    try:
        return target_of(column), False
    except RecordingError:
        return None, True


def is_name(cell: str) -> bool:
    """Return whether *cell* names a quantity, with or without a unit."""
    return _meaning(cell) != (None, False)


def _has_unit(column: str) -> bool:
    return len(re.split(r'[\s\[\](){},/_]+', column.strip('[](){} \t'))) > 1


def _is_unit(cell: str) -> bool:
    word = _words(cell)
    return cell.lower() in _OTHERS or any(unit_in(word, name) for name in QUANTITIES)


def _plain(unit: str) -> str:
    """Return a unit without the brackets around it."""
    match = _BRACKETS.fullmatch(unit)
    return match['unit'].strip() if match else unit


def _words(unit: str) -> str:
    """Return a unit as :mod:`pam_ros.recording.quantities` writes it."""
    return re.sub(r'[\s/]+', '_', unit.replace('%', 'percent'))
