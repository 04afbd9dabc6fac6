# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Read CSV files, whose column names contain the unit, into series, and write them."""

import codecs
import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pam_ros.arguments import as_path, instance
from pam_ros.errors import RecordingError
from pam_ros.recording.columns import chosen, to_series
from pam_ros.recording.mapping import ColumnMapping, Meaning
from pam_ros.recording.recording import OUTPUTS, Recording
from pam_ros.recording.series import Series

Array = NDArray[np.float64]

_COMMENTS = ('#', '%', '//')
_EMPTY = frozenset(('', 'nan', 'na', 'n/a', 'null', 'none'))
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
_SWAPPED_BREAK = '\u0a00'  # a line break whose two bytes are swapped; no character otherwise


@dataclass(frozen=True, eq=False)
class _Table:
    """The used columns of a file as text, (n,) each, and the line number of each row."""

    header: list[str]
    rows: list[list[str]]
    lines: list[int]
    decimal_comma: bool
    notes: list[str]


def read_csv(path: Path, mapping: ColumnMapping) -> tuple[dict[str, Series], list[str], list[str]]:
    """Return (signal -> series in SI, warnings, names of the columns) of a CSV file.

    A signal is a quantity, such as ``pressure``, or a quantity of one muscle:
    ``agonist.pressure``.

    The first line that is not a comment gives the names of the columns. Cells are separated by
    commas, semicolons or tabs. An empty cell (or NaN) means that no sample was taken: columns may
    have different rates. A stretch of empty cells is refused, as a sensor that failed, if it is
    longer than ten sampling periods of its column and longer than 50 ms. A column that starts or
    ends more than 1 s away from the others is refused, too. A command may be given only at its
    changes.

    Raises RecordingError with the line and the column of a cell that cannot be read.
    """
    table = _read_table(path)
    mapping.need(table.header, path.name)
    columns, notes = chosen(path.name, table.header, mapping)
    values = {
        signal: _numbers(path, table, index, meaning)
        for signal, (index, meaning) in columns.items()
    }
    lines = table.lines
    series, notes = to_series(
        path.name, table.header, mapping, columns, values, notes, lambda i: f'line {lines[i]}'
    )
    return series, table.notes + notes, table.header


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


def _read_table(path: Path) -> _Table:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise RecordingError(f'{path} cannot be read: {error.strerror}') from error
    text = _decode(path, data)
    notes = []
    content = [
        (number, line)
        for number, line in enumerate(text.splitlines(keepends=True), 1)
        if line.strip() and not line.lstrip().startswith(_COMMENTS)
    ]
    if not content:
        raise RecordingError(f'{path.name} is empty')
    last, end = content[-1]
    if len(content) > 1 and end == _unbroken(end):
        # A number that was cut off may still look valid: 13.4 may have been 13.46.
        notes.append(
            f'the last line ({last}) does not end with a line break: its last number may be cut '
            'off, and the line is left out'
        )
        content.pop()
    separator = max(';\t,', key=lambda mark: (content[0][1].count(mark), mark != ','))
    header, *rows = (_cells(path, number, line, separator) for number, line in content)
    lines = [number for number, _ in content[1:]]
    if len(header) > 1 and header[-1] == '':
        header = header[:-1]  # a separator at the end of each line
        rows = [row[:-1] if len(row) > len(header) and row[-1] == '' else row for row in rows]
    if len(header) == 1 and len(header[0].split()) > 1:
        raise RecordingError(
            f'{path.name} has one column, {header[0]!r}: the first line that is not a comment (#, '
            '% or //) names the columns; separate them by commas, semicolons or tabs'
        )
    if all(_is_number(cell) for cell in header):
        raise RecordingError(
            f'{path.name} has no line with column names: its first row is {_named(header)}; name '
            'the columns with their units, such as t_s,pressure_command_kPa,position_mm'
        )
    double = sorted({name for name in header if header.count(name) > 1})
    if double:
        raise RecordingError(f'{path.name} has several columns called {double[0]!r}')
    if rows and len(rows[-1]) < len(header):
        notes.append(f'the last line ({lines[-1]}) is cut off and left out')
        rows, lines = rows[:-1], lines[:-1]
    for row, line in zip(rows, lines, strict=True):
        if len(row) != len(header):
            raise RecordingError(
                f'{path.name}, line {line}: {len(row)} cells for {len(header)} columns'
            )
    if not rows:
        raise RecordingError(f'{path.name} has the names of columns, and no row of numbers')
    return _Table(header, rows, lines, separator != ',', notes)


def _unbroken(line: str) -> str:
    """Return *line* without the line break at its end."""
    return line.splitlines()[0]


def _cells(path: Path, number: int, line: str, separator: str) -> list[str]:
    """Return the cells of one line, which is one row: no cell may contain a line break."""
    line = _unbroken(line)
    try:
        (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True, strict=True)
    except csv.Error:
        longest = csv.field_size_limit()
        what = 'a quotation mark is not closed, or is within a cell'
        if len(line) > longest:
            what = f'a cell is longer than {longest} characters, or {what}'
        raise RecordingError(f'{path.name}, line {number}: {what}') from None
    return [cell.strip() for cell in cells]


def _decode(path: Path, data: bytes) -> str:
    """Return the text of a file; raise RecordingError if it is not a text file."""
    try:
        text = data.decode('utf-16' if data.startswith(_UTF_16) else 'utf-8-sig')
    except UnicodeDecodeError as error:
        if error.encoding == 'utf-8':
            text = data.decode('latin-1')
        else:
            raise RecordingError(
                f'{path.name} begins with the byte order mark of UTF-16, but is not UTF-16 '
                f'({error.reason} at byte {error.start} of {len(data)}): save it as UTF-8'
            ) from None
    if '\0' in text:
        raise RecordingError(f'{path.name} is not a text file: give a CSV file or a rosbag2')
    if _SWAPPED_BREAK in text:
        raise RecordingError(
            f'{path.name} begins with a byte order mark of UTF-16, and has the other byte order: '
            'save it as UTF-8'
        )
    return text


def _numbers(path: Path, table: _Table, index: int, meaning: Meaning) -> Array:
    """Return a column in SI, NaN for an empty cell."""
    cells = [row[index] for row in table.rows]
    if table.decimal_comma:
        cells = [cell.replace(',', '.', 1) for cell in cells]
    cells = ['nan' if cell.lower() in _EMPTY else cell for cell in cells]
    try:
        value = np.array(cells, dtype=float)
    except ValueError:
        i = next(i for i, cell in enumerate(cells) if not _is_number(cell))
        raise RecordingError(
            f'{path.name}, line {table.lines[i]}: {table.header[index]} = '
            f'{table.rows[i][index]!r} is not a number'
        ) from None
    factor, offset = meaning.to_si
    scaled: Array = value * factor + offset
    return scaled


def _is_number(cell: str) -> bool:
    try:
        float(cell.replace(',', '.', 1))
    except ValueError:
        return False
    return True


def _named(names: list[str]) -> str:
    shown = names[:12]
    return ', '.join(shown) + (f' and {len(names) - 12} more' if len(names) > 12 else '')
