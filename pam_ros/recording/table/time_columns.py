# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The column, or the two columns, of a table that have the times as dates and clock times."""

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError
from pam_ros.recording.mapping import ColumnMapping, Meaning
from pam_ros.recording.quantities import Target
from pam_ros.recording.series import COARSE
from pam_ros.recording.table.found import Table
from pam_ros.recording.table.time_stamps import BOTH, CLOCK, DATE, kind_of, seconds

Array = NDArray[np.float64]
SECONDS = Meaning(Target('time', 's'))
_WORDS = {'t', 'time', 'timestamp', 'stamp', 'datetime', 'clock', 'date', 'day'}


def with_times(
    name: str, table: Table, mapping: ColumnMapping
) -> tuple[ColumnMapping, dict[str, Array], list[str]]:
    """Return the mapping with the column of the times, its values in s, and notes.

    The times of the file *name* are in the columns of *table* whose names contain a word such as
    time or date, or that *mapping* calls ``t_s``, and whose cells are times. If another column
    has the time as numbers, they are not used. Raises RecordingError if several give the time.
    """
    kinds = {column: kind for column in table.header if (kind := _kind(table, mapping, column))}
    if not kinds:
        return mapping, {}, []
    numeric = [one for one in table.header if one not in kinds and _is_time(mapping, one)]
    dates = [one for one, kind in kinds.items() if kind == DATE]
    times = [one for one, kind in kinds.items() if kind == BOTH]
    times = times or [one for one, kind in kinds.items() if kind == CLOCK]
    chosen = [one for one in times if one in mapping] or times
    if len(chosen) > 1 and not numeric:
        raise RecordingError(
            f'{name}: columns {chosen[0]!r} and {chosen[1]!r} both give the time: leave one out '
            f"with --column '{chosen[1]}=ignore'"
        )
    if numeric or not chosen:
        others = {column: None for column in kinds if column not in mapping}
        notes = [f'columns not used: {", ".join(others)}'] if others else []
        return ColumnMapping({**mapping.meanings, **others}), {}, notes
    (column,) = chosen
    with_date = dates[0] if kinds[column] == CLOCK and len(dates) == 1 else None
    cells = _cells(table, column)
    if with_date is not None:
        days = _cells(table, with_date)
        cells = [f'{day} {time}' if time else '' for day, time in zip(days, cells, strict=True)]
    t = seconds(column, cells)
    _check_clock(name, column, cells, t)
    others = dict.fromkeys(one for one in kinds if one not in mapping)
    return ColumnMapping({**mapping.meanings, **others, column: SECONDS}), {column: t}, []


def _kind(table: Table, mapping: ColumnMapping, column: str) -> str | None:
    """Return the kind of the times in a *column*, None if it does not have such times."""
    if column in mapping:
        if mapping.meaning(column) != SECONDS:
            return None
    elif _WORDS.isdisjoint(re.split(r'[^a-z]+', column.lower())):
        return None
    index = table.header.index(column)
    return kind_of(next((row[index] for row in table.rows if row[index]), ''))


def _is_time(mapping: ColumnMapping, column: str) -> bool:
    """Return whether a *column* is the time, as numbers."""
    try:
        meaning = mapping.meaning(column)
    except RecordingError:
        return False
    return meaning is not None and meaning.target.quantity == 'time'


def _cells(table: Table, column: str) -> list[str]:
    index = table.header.index(column)
    return [row[index] for row in table.rows]


def _check_clock(name: str, column: str, cells: Sequence[str], t: Array) -> None:
    """Raise RecordingError if the times of a *column* are whole seconds, and many are equal."""
    repeated = int(np.count_nonzero(np.diff(t) == 0.0))
    if repeated > max(COARSE * t.size, 2) and not np.any(t % 1.0):
        raise RecordingError(
            f'{name}: {column} = {cells[0]!r} and all others are whole seconds, and {repeated} of '
            f'{t.size} are the same as the one before: save the times with milliseconds (in a '
            'spreadsheet, the format of such cells is yyyy-mm-dd hh:mm:ss.000)'
        )
