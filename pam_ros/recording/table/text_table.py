# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A text file with a line of column names and rows of cells, before its cells are numbers."""

import csv
import re
from collections.abc import Sequence
from pathlib import Path

from pam_ros.errors import RecordingError
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.table.found import Table, table_in
from pam_ros.recording.table.search import is_row
from pam_ros.recording.table.text_file import TextLines, read_lines

_SEPARATORS = (';', '\t', ',')
_EXCEL = re.compile(r'sep=(?P<mark>[;,\t])', re.IGNORECASE)  # a first line for Excel alone
_SAMPLES = 100  # lines of which the separator is found


def read_table(path: Path, mapping: ColumnMapping, columns: Sequence[str] = ()) -> Table:
    """Return the table in the file at *path*, with the names *columns* if they are given.

    *mapping* names columns: of several tables in a file, the only one with known columns is read.
    Raises RecordingError if the file has no table.
    """
    found = read_lines(path)
    separator = _separator(found)
    if _EXCEL.fullmatch(found.lines[0][1].strip()) and len(found.lines) > 1:
        found.lines.pop(0)
    source = _TextSource(path.name, found, separator)
    table = table_in(source, mapping, columns)
    return Table(table.header, table.rows, table.lines, found.notes + table.notes)


class _TextSource:
    """The cells of the lines of a text file: see :class:`pam_ros.recording.table.found.Source`."""

    def __init__(self, name: str, found: TextLines, separator: str) -> None:
        self.name = name
        self._lines = found.lines
        self._comments = found.comments
        self._separator = separator
        longest = max(len(line) for _, line in self._lines)
        self._is_plain = longest <= csv.field_size_limit() and not any(
            '"' in line for _, line in self._lines
        )
        self._is_spaced = found.spaced
        self._begin = re.compile(rf'[\s"{separator}]*[-+.,\d]')

    @property
    def count(self) -> int:
        return len(self._lines)

    def number(self, i: int) -> int:
        return self._lines[i][0]

    def may_be_row(self, i: int) -> bool:
        return self._begin.match(self._lines[i][1]) is not None

    def cells(self, i: int) -> list[str]:
        """Return the cells of a line that may be of a table, or not."""
        try:
            return _cells(self._lines[i][1], self._separator)
        except csv.Error:
            return [cell.strip() for cell in self._lines[i][1].split(self._separator)]

    def row(self, i: int) -> list[str]:
        """Return the cells of a line of the table; no cell may contain a line break."""
        line = self._lines[i][1]
        if self._is_plain:
            cells = line.split(self._separator)
            return [cell.strip() for cell in cells] if self._is_spaced else cells
        try:
            return _cells(line, self._separator)
        except csv.Error:
            longest = csv.field_size_limit()
            what = 'a quotation mark is not closed, or is within a cell'
            if len(line) > longest:
                what = f'a cell is longer than {longest} characters, or {what}'
            raise RecordingError(f'{self.name}, line {self.number(i)}: {what}') from None

    def comment_above(self, i: int) -> tuple[int, list[str]] | None:
        """Return the number and the cells of the last comment above the line i."""
        above = [one for one in self._comments if one[0] < self._lines[i][0]]
        if not above:
            return None
        number, line = above[-1]
        text = line.strip().lstrip('#%/')
        cells = [cell.strip() for cell in text.split(self._separator)]
        return number, cells


def _separator(found: TextLines) -> str:
    """Return the mark between the cells: that with which most lines are rows of numbers."""
    lines = [line for _, line in found.lines]
    told = _EXCEL.fullmatch(lines[0].strip())
    if told:
        return told['mark']
    some = lines[:: max(1, len(lines) // _SAMPLES)]
    rows = {mark: sum(is_row(_split(line, mark)) for line in some) for mark in _SEPARATORS}
    counts = {mark: lines[0].count(mark) for mark in _SEPARATORS}
    # In "0,01;1,5" the comma separates no numbers; without rows, the line of the names decides.
    return max(_SEPARATORS, key=lambda mark: (rows[mark], counts[mark]))


def _split(line: str, separator: str) -> list[str]:
    try:
        return _cells(line, separator)
    except csv.Error:
        return []


def _cells(line: str, separator: str) -> list[str]:
    (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True, strict=True)
    return [cell.strip() for cell in cells]
