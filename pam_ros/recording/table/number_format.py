# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How the numbers of a text file are written: the decimal mark, and marks of thousands.

1,204 is 1204 in one file and 1.204 in another. This is decided for whole columns, from all of
their cells and from the other columns of the file, and never cell by cell.
"""

import re
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError

Array = NDArray[np.float64]
MARKS = ('.', ',')  # decimal marks; the other one may separate thousands
OTHER = {'.': ',', ',': '.'}
EMPTY = frozenset(('', 'nan', 'na', 'n/a', 'null', 'none'))
# Marks of thousands in both: spaces, also those that do not break a line, and apostrophes.
_SPACES = " '\u2019\u00a0\u202f"
GROUP = 3  # digits between two marks of thousands
_SPECIAL = r'(?:na|n/a|null|none|[+-]?(?:nan|inf|infinity))?'


def _pattern(decimal: str, thousands: str) -> str:
    """Return the expression of a number, with groups of three digits or without."""
    groups = rf'[1-9]\d{{0,2}}(?P<mark>[{thousands}{_SPACES}])\d{{3}}(?:(?P=mark)\d{{3}})*'
    fraction = rf'(?:[{decimal}]\d*)?'
    return rf'[+-]?(?:{groups}{fraction}|\d+{fraction}|[{decimal}]\d+)(?:[eE][+-]?\d+)?'


# For each decimal mark, a cell that is not a number with it.
_NOT = {
    mark: re.compile(
        rf'^(?!(?:{_pattern(mark, OTHER[mark])}|{_SPECIAL})$).+$', re.MULTILINE | re.IGNORECASE
    )
    for mark in MARKS
}


class UnreadableCellError(RecordingError):
    """A cell is not a number, or not a time; ``row`` is its index."""

    def __init__(self, row: int, column: str, cell: str, what: str = 'a number') -> None:
        """Refuse the *cell* of this *row* in this *column*, which is not *what*."""
        super().__init__(f'{column} = {cell!r} is not {what}')
        self.row = row


def is_number(cell: str) -> bool:
    """Return whether a cell is a number, written in any way."""
    return bool(cell) and not all(one.search(cell) for one in _NOT.values())


def numbers(name: str, cells: Mapping[str, Sequence[str]]) -> dict[str, Array]:
    """Return the columns *cells* (n,) of the file *name* as numbers, NaN for an empty cell.

    Raises UnreadableCellError for a cell that is not a number, and RecordingError for a column
    that can be read in two ways.
    """
    found = {column: _plain(one) for column, one in cells.items()}
    if all(value is not None for value in found.values()):
        return {column: value for column, value in found.items() if value is not None}
    marks = {column: _decimal_marks(column, one) for column, one in cells.items()}
    of_file = {only for only, *others in marks.values() if not others}
    numbered = {}
    for column, one in cells.items():
        mark = _chosen(name, column, one, marks[column], of_file)
        value = found[column] if mark == '.' else None
        numbered[column] = _converted(one, mark) if value is None else value
    return numbered


def _plain(cells: Sequence[str]) -> Array | None:
    """Return cells with decimal points as numbers, None if others are among them."""
    try:
        return np.array(cells, dtype=float)
    except ValueError:
        pass
    try:
        return np.array(['nan' if cell.lower() in EMPTY else cell for cell in cells], dtype=float)
    except ValueError:
        return None


def _decimal_marks(column: str, cells: Sequence[str]) -> list[str]:
    """Return the decimal marks with which all cells are numbers: both, where none has a mark."""
    text = '\n'.join(cells)
    wrong = {mark: one.search(text) for mark, one in _NOT.items()}
    marks = [mark for mark, cell in wrong.items() if cell is None]
    if not marks:
        # A point in a column with commas is wrong for one mark, and a word for both.
        row = max(text.count('\n', 0, one.start()) for one in wrong.values() if one)
        raise UnreadableCellError(row, column, cells[row])
    return marks


def _chosen(
    name: str, column: str, cells: Sequence[str], marks: list[str], of_file: set[str]
) -> str:
    """Return the decimal mark of a column, from its cells and from the marks of other columns."""
    if len(marks) == 1:
        return marks[0]
    if len(of_file) == 1:
        return next(iter(of_file))
    grouped = next((cell for cell in cells if ',' in cell), '')
    if not grouped:
        return '.'
    # Whole numbers without a mark are below 1000 if the mark is that of thousands.
    whole = [cell.lstrip('+-') for cell in cells if cell.lstrip('+-').isdecimal()]
    if whole:
        return ',' if any(len(cell) > GROUP for cell in whole) else '.'
    as_thousands, as_decimal = grouped.replace(',', ''), grouped.replace(',', '.')
    raise RecordingError(
        f'{name}: {column} = {grouped} can be {as_thousands} or {as_decimal}, like all values of '
        'this column: write decimal points and no marks of thousands'
    )


def _converted(cells: Sequence[str], mark: str) -> Array:
    """Return cells with this decimal mark as numbers (n,)."""
    table = dict.fromkeys(map(ord, f'{OTHER[mark]}{_SPACES}')) | {ord(mark): '.'}
    texts = ('nan' if cell.lower() in EMPTY else cell.translate(table) for cell in cells)
    return np.array([*texts], dtype=float)
