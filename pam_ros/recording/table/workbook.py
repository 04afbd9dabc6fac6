# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The table in a sheet of an Excel workbook (.xlsx)."""

import datetime
import warnings
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pam_ros.errors import RecordingError
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.table.found import Table, table_in
from pam_ros.recording.table.search import is_row, is_value

SUFFIXES = ('.xlsx', '.xlsm')
_GROUP = 3  # digits that could follow a mark of thousands


def read_workbook(
    path: Path, mapping: ColumnMapping, columns: Sequence[str] = (), sheet: str | None = None
) -> Table:
    """Return the table in a sheet of the workbook at *path*, with the names *columns* if given.

    *sheet* is the name of the sheet, None if only one has a row of numbers. The table is found as
    in a text file. Raises RecordingError if the workbook cannot be read, or has no table.
    """
    lines = {name: _lines(rows) for name, rows in _sheets(path, True).items()}
    chosen = _chosen(path.name, lines, sheet)
    if not lines[chosen]:
        raise RecordingError(f'{path.name}: the sheet {chosen!r} is empty')
    source = _SheetSource(path.name, lines[chosen])
    table = table_in(source, mapping, columns)
    if any('' in row for row in table.rows):
        _check_formulas(path, chosen, table)
    return table


class _SheetSource:
    """The rows of a sheet that are not empty: a :class:`pam_ros.recording.table.found.Source`."""

    def __init__(self, name: str, lines: list[tuple[int, list[str]]]) -> None:
        self.name = name
        self._lines = lines

    @property
    def count(self) -> int:
        return len(self._lines)

    def number(self, i: int) -> int:
        return self._lines[i][0]

    def may_be_row(self, i: int) -> bool:
        return is_value(next(cell for cell in self._lines[i][1] if cell))

    def cells(self, i: int) -> list[str]:
        return self._lines[i][1]

    def row(self, i: int) -> list[str]:
        return self._lines[i][1]

    def comment_above(self, i: int) -> None:
        """Return None: sheets have no comments."""


def _sheets(path: Path, values: bool) -> dict[str, list[tuple[Any, ...]]]:
    """Return sheet -> its rows, with the *values* of formulas or with the formulas."""
    try:
        import openpyxl
    except ImportError:
        raise RecordingError(
            f'{path.name} is an Excel workbook, and openpyxl, which reads it, is not installed: '
            'install it with pip install openpyxl or apt install python3-openpyxl, or save the '
            'sheet as CSV'
        ) from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # of styles and extensions, which are not read
            book = openpyxl.load_workbook(path, read_only=True, data_only=values)
            try:
                return {one.title: [*one.iter_rows(values_only=True)] for one in book.worksheets}
            finally:
                book.close()
    except (zipfile.BadZipFile, KeyError, ValueError, TypeError, SyntaxError, EOFError) as error:
        raise RecordingError(
            f'{path.name} is not a valid .xlsx workbook, or has a password ({error}): save it '
            'again as .xlsx without a password, or save the sheet as CSV'
        ) from error
    except OSError as error:
        raise RecordingError(f'{path} cannot be read: {error.strerror}') from error


def _lines(rows: Sequence[tuple[Any, ...]]) -> list[tuple[int, list[str]]]:
    """Return the number and the cells of each row that is not empty."""
    texts = ((number, [_text(value) for value in row]) for number, row in enumerate(rows, 1))
    return [(number, cells) for number, cells in texts if any(cells)]


def _text(value: object) -> str:
    """Return the value of a cell as text: numbers with a decimal point, dates as in ISO 8601."""
    if value is None:
        return ''
    if isinstance(value, float):
        text = repr(value)
        # 1.2340 cannot be mistaken for 1234 with a mark of thousands.
        return text + '0' if len(text.partition('.')[2]) == _GROUP else text
    if isinstance(value, datetime.datetime):
        return value.isoformat(' ', 'microseconds')
    if isinstance(value, datetime.time):
        return value.isoformat('microseconds')
    if isinstance(value, datetime.timedelta):
        hours, rest = divmod(value, datetime.timedelta(hours=1))
        return f'{hours:02d}:{(datetime.datetime.min + rest):%M:%S.%f}'
    return str(value).strip()


def _chosen(name: str, lines: dict[str, list[tuple[int, list[str]]]], sheet: str | None) -> str:
    """Return the name of the sheet to be read."""
    named = ', '.join(map(repr, lines))
    if sheet is not None:
        if sheet not in lines:
            raise RecordingError(f'{name} has no sheet {sheet!r}: it has {named or "none"}')
        return sheet
    usable = [one for one, rows in lines.items() if any(is_row(cells) for _, cells in rows)]
    if len(usable) > 1:
        raise RecordingError(
            f'{name} has {len(usable)} sheets with numbers, {", ".join(map(repr, usable))}: '
            'choose one with --sheet'
        )
    if not usable:
        raise RecordingError(f'{name} has no sheet with rows of numbers: it has {named or "none"}')
    return usable[0]


def _check_formulas(path: Path, sheet: str, table: Table) -> None:
    """Raise RecordingError if a cell of the table is a formula whose value is not stored."""
    rows = _sheets(path, False)[sheet]
    for number, cells in zip(table.lines, table.rows, strict=True):
        for column, (value, cell) in enumerate(zip(rows[number - 1], cells, strict=False)):
            if cell == '' and isinstance(value, str) and value.startswith('='):
                name = table.header[column] or f'column {column + 1}'
                raise RecordingError(
                    f'{path.name}, line {number}: {name} is the formula {value}, and its value '
                    'is not stored: open the workbook in a spreadsheet program and save it'
                )
