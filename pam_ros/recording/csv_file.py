# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Read CSV files, whose column names contain the unit, into series, and write them."""

import csv
import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pam_ros.arguments import as_path, instance
from pam_ros.errors import RecordingError
from pam_ros.recording.columns import chosen, to_series
from pam_ros.recording.mapping import ColumnMapping, Meaning
from pam_ros.recording.recording import OUTPUTS, Recording
from pam_ros.recording.series import Series
from pam_ros.recording.table.found import Table
from pam_ros.recording.table.number_format import UnreadableCellError, numbers
from pam_ros.recording.table.text_table import read_table
from pam_ros.recording.table.time_columns import with_times

Array = NDArray[np.float64]


def read_csv(
    path: Path, mapping: ColumnMapping, columns: Sequence[str] = ()
) -> tuple[dict[str, Series], list[str], list[str]]:
    """Return (signal -> series in SI, warnings, names of the columns) of a CSV file.

    A signal is a quantity, such as ``pressure``, or a quantity of one muscle:
    ``agonist.pressure``.

    The line above the rows of numbers gives the names of the columns, unless *columns* are given;
    it may be followed by a row of units. Lines before and after the table are left out with a
    warning (see ``pam_ros.recording.table``). Cells are separated by commas, semicolons or
    tabs; a decimal comma, and marks of thousands, are found for each column (see
    :mod:`pam_ros.recording.table.number_format`).

    An empty cell (or NaN) means that no sample was taken: columns may have different rates. A
    stretch of empty cells is refused, as a sensor that failed, if it is longer than ten sampling
    periods of its column and longer than 50 ms. A column that starts or ends more than 1 s away
    from the others is refused, too. A command may be given only at its changes.

    Raises RecordingError with the line and the column of a cell that cannot be read.
    """
    return series_of_table(path.name, read_table(path, mapping, columns), mapping)


def series_of_table(
    name: str, table: Table, mapping: ColumnMapping
) -> tuple[dict[str, Series], list[str], list[str]]:
    """Return (signal -> series in SI, warnings, names of the columns) of a table of cells.

    *name* is that of its file. Raises RecordingError as :func:`read_csv`.
    """
    mapping.need(table.header, name)
    lines = table.lines
    try:
        mapping, times, clock_notes = with_times(name, table, mapping)
        found, notes = chosen(name, table.header, mapping)
        values = _values(name, table, found, times)
    except UnreadableCellError as error:
        raise RecordingError(f'{name}, line {lines[error.row]}: {error}') from None
    series, notes = to_series(
        name, table.header, mapping, found, values, notes, lambda i: f'line {lines[i]}'
    )
    return series, table.notes + clock_notes + notes, table.header


def write_csv(recording: Recording, path: str | Path) -> None:
    """Write *recording* as a CSV file that gives the same numbers when it is read.

    *path* is that of the file, which is replaced. Columns are in SI, with the unit in their names:
    ``t_s``, ``pressure_command_Pa``, ``position_m`` or ``position_rad``, ``force_N``; those of a
    muscle begin with its name and a dot. A command with a stamp that no output has
    gets its own row, in which the other cells are empty. Raises RecordingError if the file cannot
    be written, and ParameterError for arguments of a wrong type.
    """
    instance('recording', recording, Recording, 'a Recording')
    path = as_path('path', path, 'the path of a file')
    units = {'velocity': f'{recording.unit}_s', 'force': 'N', 'pressure': 'Pa'}
    units['position'] = recording.unit
    stamps = recording.t
    columns: list[tuple[str, Array, Array]] = []  # header, stamps and values of each
    if recording.command_t is not None and recording.command is not None:
        stamps = np.union1d(recording.t, recording.command_t)
        for whose, value in _by_muscle(recording, recording.command):
            columns.append((f'{whose}pressure_command_Pa', recording.command_t, value))
    for name in OUTPUTS:
        measured = getattr(recording, name)
        if measured is not None:
            for whose, value in _by_muscle(recording, measured):
                columns.append((f'{whose}{name}_{units[name]}', recording.t, value))
    cells: list[Sequence[str]] = [[repr(float(x)) for x in stamps]]
    cells += [_spread(stamps, t, value) for _, t, value in columns]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator='\n')
    writer.writerow(['t_s', *(header for header, _, _ in columns)])
    writer.writerows(zip(*cells, strict=True))
    partial = path.with_name(path.name + '.part')
    try:
        partial.write_text(text.getvalue(), encoding='utf-8')
        partial.replace(path)
    except OSError as error:
        partial.unlink(missing_ok=True)
        raise RecordingError(f'{path} cannot be written: {error.strerror}') from error


def _by_muscle(recording: Recording, values: Array) -> list[tuple[str, Array]]:
    """Return for each muscle the prefix of its column names, and its values (n,)."""
    if values.ndim == 1:
        return [('', values)]
    return [(f'{name}.', values[:, i]) for i, name in enumerate(recording.muscles)]


def _spread(stamps: Array, t: Array, value: Array) -> list[str]:
    cells = [''] * stamps.size
    for i, x in zip(np.searchsorted(stamps, t), value, strict=True):
        cells[int(i)] = repr(float(x))
    return cells


def _values(
    name: str,
    table: Table,
    columns: dict[str, tuple[int, Meaning]],
    times: dict[str, Array],
) -> dict[str, Array]:
    """Return signal -> its column in SI, NaN for an empty cell; *times* are those of columns."""
    named = {table.header[index]: index for index, _ in columns.values()}
    cells = {
        column: [row[index] for row in table.rows]
        for column, index in named.items()
        if column not in times
    }
    found = numbers(name, cells) | times
    values = {}
    for signal, (index, meaning) in columns.items():
        factor, offset = meaning.to_si
        values[signal] = found[table.header[index]] * factor + offset
    return values
