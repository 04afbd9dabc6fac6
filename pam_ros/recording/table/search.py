# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Find the tables in a file: rows of numbers, and the line with the names of their columns.

Measuring programs write texts, settings and units above a table, and loggers print messages.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import chain

from pam_ros.recording.table.number_format import is_number
from pam_ros.recording.table.time_stamps import kind_of
from pam_ros.recording.table.units_row import is_units

Cells = Sequence[str]


@dataclass(frozen=True)
class Block:
    """A table: the indices of its rows, and of the lines with its names and its units, if any."""

    names: int | None
    units: int | None
    rows: Sequence[int]


@dataclass(frozen=True)
class Search:
    """Find the tables in *count* lines.

    ``cells(i)`` are those of the line i. ``may_be_row(i)`` is a fast test that is true of each row
    that begins with a number; ``is_known(cells)`` is true if a name of a column is known.
    """

    count: int
    cells: Callable[[int], Cells]
    may_be_row: Callable[[int], bool]
    is_known: Callable[[Cells], bool]
    _found: list[Block] = field(default_factory=list)

    def blocks(self) -> list[Block]:
        """Return the tables in their order; empty if no line is a row of numbers."""
        start = 0
        while (first := self._next_row(start)) is not None:
            names, units = self._names_above(first, start)
            after = self._next_row(first + 1) if names is None else None
            if after not in (None, first + 1) and self._names_above(after or 0, first + 1)[0]:
                start = first + 1  # the rest of a line of a logger that was already running
                continue
            end = self._end(first, names)
            last = self._last_row(first, end)
            self._found.append(Block(names, units, range(first, last + 1)))
            start = last + 1
            if end == self.count:
                break
        return self._found

    def _next_row(self, start: int) -> int | None:
        return next((i for i in range(start, self.count) if is_row(self.cells(i))), None)

    def _names_above(self, row: int, start: int) -> tuple[int | None, int | None]:
        """Return the lines with the names and the units of the table that begins at *row*."""
        above = [i for i in range(row - 1, start - 1, -1) if len(_filled(self.cells(i))) > 1]
        texts = [i for i in above if not any(map(is_value, self.cells(i)))]
        # Names may be numbers, such as those of channels, but not if there is a line of words.
        for i in texts or [i for i in above if not is_row(self.cells(i))]:
            over = i - 1
            if over in texts and is_units(self.cells(i), self.cells(over)):
                return over, i
            return i, None
        return None, None

    def _end(self, first: int, names: int | None) -> int:
        """Return the line at which the next table begins, or the number of lines."""
        own = None if names is None else self.cells(names)
        for i in range(first + 1, self.count - 1):
            if not self.may_be_row(i) and self._begins(i, own):
                return i
        return self.count

    def _begins(self, i: int, own: Cells | None) -> bool:
        """Return whether the line i names the columns of another table."""
        cells = self.cells(i)
        names = _filled(cells)
        if len(names) < 2 or len(set(names)) < len(names) or any(map(is_value, names)):
            return False
        if not (cells == own or self.is_known(cells) or len(_filled(self.cells(i - 1))) == 1):
            return False
        below = [j for j in (i + 1, i + 2) if j < self.count]
        if below and is_row(self.cells(below[0])):
            return True
        return (
            len(below) > 1
            and is_units(self.cells(below[0]), cells)
            and is_row(self.cells(below[1]))
        )

    def _last_row(self, first: int, end: int) -> int:
        """Return the last row before *end*: the texts behind a table are no part of it."""
        last = end - 1
        while last > first:
            cells = _filled(self.cells(last))
            is_spoiled = end == self.count and 2 * sum(map(is_value, cells)) >= len(cells) > 0
            if is_spoiled or is_row(self.cells(last)):
                break
            last -= 1
        return last


def joined(blocks: Sequence[Block], cells: Callable[[int], Cells]) -> list[Block]:
    """Return the tables, those with the same names of columns as one."""
    alike: dict[tuple[str, ...] | None, list[Block]] = {}
    for block in blocks:
        key = None if block.names is None else tuple(cells(block.names))
        alike.setdefault(key, []).append(block)
    return [
        one[0] if len(one) == 1 else Block(one[0].names, one[0].units, _rows(one))
        for one in alike.values()
    ]


def _rows(blocks: Sequence[Block]) -> list[int]:
    return [*chain.from_iterable(block.rows for block in blocks)]


def is_value(cell: str) -> bool:
    """Return whether a cell is a number, a time, or says that there is none, such as NaN."""
    return any(map(str.isalnum, cell)) and (is_number(cell) or kind_of(cell) is not None)


def is_row(cells: Cells) -> bool:
    """Return whether a line is a row of a table: its first cell and most cells are numbers."""
    filled = _filled(cells)
    if len(cells) < 2 or not filled or not is_value(filled[0]):
        return False
    return 2 * sum(map(is_value, filled)) >= len(filled)


def _filled(cells: Cells) -> list[str]:
    return [cell for cell in cells if cell]
