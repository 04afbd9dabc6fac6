# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A text file with a line of column names and rows of cells, before its cells are numbers."""

import codecs
import csv
from dataclasses import dataclass
from pathlib import Path

from pam_ros.errors import RecordingError
from pam_ros.recording.number_format import is_number

_COMMENTS = ('#', '%', '//')
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
_SWAPPED_BREAK = '\u0a00'  # a line break whose two bytes are swapped; no character otherwise


@dataclass(frozen=True, eq=False)
class TextTable:
    """The names of the columns, the rows of cells, and the number of the line of each row.

    A column without a name has the name ''. ``notes`` are warnings about the file.
    """

    header: list[str]
    rows: list[list[str]]
    lines: list[int]
    notes: list[str]


def read_table(path: Path) -> TextTable:
    """Return the table in the file at *path*; raises RecordingError if it has none."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise RecordingError(f'{path} cannot be read: {error.strerror}') from error
    text, notes = _decode(path, data)
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
    _check_header(path, header)
    table = TextTable(header, rows, lines, notes)
    _check_rows(path, table)
    return table


def _check_header(path: Path, header: list[str]) -> None:
    """Raise RecordingError if the first line does not name the columns."""
    if len(header) == 1 and len(header[0].split()) > 1:
        raise RecordingError(
            f'{path.name} has one column, {header[0]!r}: the first line that is not a comment (#, '
            '% or //) names the columns; separate them by commas, semicolons or tabs'
        )
    named = [name for name in header if name]
    if all(map(is_number, named)):
        raise RecordingError(
            f'{path.name} has no line with column names: its first row is {_named(header)}; name '
            'the columns with their units, such as t_s,pressure_command_kPa,position_mm'
        )
    double = sorted({name for name in named if named.count(name) > 1})
    if double:
        raise RecordingError(f'{path.name} has several columns called {double[0]!r}')


def _check_rows(path: Path, table: TextTable) -> None:
    """Give all rows a cell for each column; raise RecordingError for a row that lacks some.

    Spreadsheets write separators for empty cells at the end of some lines, and of others not.
    """
    header, rows, lines = table.header, table.rows, table.lines
    count, least = len(header), max(i for i, name in enumerate(header) if name) + 1
    if rows and len(rows[-1]) < least:
        table.notes.append(f'the last line ({lines[-1]}) is cut off and left out')
        rows.pop()
        lines.pop()
    for i, row in enumerate(rows):
        if len(row) == count:
            continue
        if len(row) < least or any(row[count:]):
            raise RecordingError(
                f'{path.name}, line {lines[i]}: {len(row)} cells for {count} columns'
            )
        rows[i] = [*row, *[''] * (count - len(row))][:count]
    if not rows:
        raise RecordingError(f'{path.name} has the names of columns, and no row of numbers')
    unnamed = [i for i, name in enumerate(header) if not name and any(row[i] for row in rows)]
    if unnamed:
        which = ', '.join(str(i + 1) for i in unnamed)
        table.notes.append(f'columns without a name are not used: {which} of {count}')


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


def _decode(path: Path, data: bytes) -> tuple[str, list[str]]:
    """Return the text of a file and notes; raise RecordingError if it is not a text file."""
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
    notes = []
    filled = text.rstrip('\0')
    if filled and len(filled) < len(text):
        # A logger that loses its power leaves the rest of the last block of its card empty.
        notes.append(f'the file ends with {len(text) - len(filled)} NUL bytes, which are left out')
        text = filled
    if '\0' in text:
        raise RecordingError(f'{path.name} is not a text file: give a CSV file or a rosbag2')
    if _SWAPPED_BREAK in text:
        raise RecordingError(
            f'{path.name} begins with a byte order mark of UTF-16, and has the other byte order: '
            'save it as UTF-8'
        )
    return text, notes


def _named(names: list[str]) -> str:
    shown = names[:12]
    return ', '.join(shown) + (f' and {len(names) - 12} more' if len(names) > 12 else '')
