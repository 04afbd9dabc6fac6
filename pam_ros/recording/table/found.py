# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The table in a file of lines of cells: its names, its units and its rows, all else left out."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

from pam_ros.errors import RecordingError
from pam_ros.recording.mapping import UNUSED, ColumnMapping
from pam_ros.recording.table.search import Block, Search, is_value, joined
from pam_ros.recording.table.units_row import is_name, with_units

_SHOWN = 12  # cells in a message
_FIRST_ROWS = 9  # rows of which the number of columns is found
_COMMENT = 'comment'  # LabVIEW names a last column so, and most rows do not have it


@dataclass(frozen=True, eq=False)
class Table:
    """The names of the columns, the rows of cells, and the number of the line of each row.

    A column without a name has the name ''. ``notes`` are warnings about the file.
    """

    header: list[str]
    rows: list[list[str]]
    lines: list[int]
    notes: list[str]


class Source(Protocol):
    """A file whose lines have cells; ``i`` is the index of a line that has content.

    ``cells(i)`` can be asked of any line, ``row(i)`` is for lines of the table and raises
    RecordingError if it is not valid. ``may_be_row(i)`` is False only if the line does not begin
    with a number. ``number(i)`` is that of the line in the file. ``comment_above(i)`` has the
    number and the cells of the last comment above the line, if there is one.
    """

    @property
    def name(self) -> str: ...  # noqa: D102
    @property
    def count(self) -> int: ...  # noqa: D102
    def cells(self, i: int) -> list[str]: ...  # noqa: D102
    def row(self, i: int) -> list[str]: ...  # noqa: D102
    def may_be_row(self, i: int) -> bool: ...  # noqa: D102
    def number(self, i: int) -> int: ...  # noqa: D102
    def comment_above(self, i: int) -> tuple[int, list[str]] | None: ...  # noqa: D102


def table_in(source: Source, mapping: ColumnMapping, columns: Sequence[str] = ()) -> Table:
    """Return the table in *source*, with the names *columns* if they are given.

    Names in *mapping* are known. Raises RecordingError if there is no table, or several of which
    it is not clear which one is meant.
    """

    def is_known(cells: Sequence[str]) -> bool:
        return any(cell in mapping or is_name(cell) for cell in cells)

    blocks = Search(source.count, source.cells, source.may_be_row, is_known).blocks()
    if blocks:
        block = _chosen(source, joined(blocks, source.cells), mapping, columns)
    else:
        block = Block(None if columns else 0, None, range(0 if columns else 1, source.count))
    rows = [source.row(i) for i in block.rows]
    header, notes = _names(source, block, rows, columns)
    if block.units is not None:
        line = f'line {source.number(block.units)}'
        header = with_units(source.name, header, source.row(block.units), line, mapping)
    _check_header(source.name, header)
    lines = [source.number(i) for i in block.rows]
    table = Table(header, rows, lines, _left_out(source, block) + notes)
    _check_rows(source.name, table, columns)
    return table


def _chosen(
    source: Source, blocks: list[Block], mapping: ColumnMapping, columns: Sequence[str]
) -> Block:
    """Return the only table, or the only one of several that has the *columns* or known ones."""
    if len(blocks) == 1:
        return blocks[0]
    if columns:
        usable = [one for one in blocks if len(source.cells(one.rows[0])) == len(columns)]
    else:
        usable = [one for one in blocks if _is_recording(source, one, mapping)]
    if len(usable) == 1:
        return usable[0]
    where = ' and '.join(
        f'lines {source.number(one.rows[0])} to {source.number(one.rows[-1])}'
        + ('' if one.names is None else f' ({_listed(source.cells(one.names))})')
        for one in blocks
    )
    raise RecordingError(
        f'{source.name} has {len(blocks)} tables, in {where}: save the one that is meant as a '
        'file of its own'
    )


def _is_recording(source: Source, block: Block, mapping: ColumnMapping) -> bool:
    """Return whether a table has a column that is known and is not the time."""
    if block.names is None:
        return False
    for cell in source.cells(block.names):
        try:
            meaning = mapping.meaning(cell)
        except RecordingError:
            meaning = None
            if not cell.lower().startswith('time'):
                return True
        if meaning is not None and meaning.target.quantity != 'time':
            return True
    return False


def _names(
    source: Source, block: Block, rows: Sequence[Sequence[str]], columns: Sequence[str]
) -> tuple[list[str], list[str]]:
    """Return the names of the columns of a table, and a note if they stand in another place."""
    widths = Counter(len(row) for row in rows[:_FIRST_ROWS]).most_common(1)
    width = widths[0][0] if widths else 0
    if columns:
        header = _given(source.name, rows, width, columns)
        if block.names is None:
            return header, []
        line = source.number(block.names)
        return header, [f'the names of the columns are those given, and not those of line {line}']
    if block.names is not None:
        return source.row(block.names), []
    above = source.comment_above(block.rows[0])
    if above is not None:
        line, names = above
        if len(names) == width > 1 and all(names) and not any(map(is_value, names)):
            return names, [f'the names of the columns are those of the comment in line {line}']
    where = source.number(block.rows[0])
    raise RecordingError(
        f'{source.name} has no line with column names: its first row is {_listed(rows[0])} (line '
        f'{where}); name the columns with their units, such as with --columns '
        f't_s,pressure_command_kPa,position_mm, with {UNUSED} for a column that is not used'
    )


def _given(
    name: str, rows: Sequence[Sequence[str]], width: int, columns: Sequence[str]
) -> list[str]:
    """Return the *columns* that are given for rows of *width* cells, '' for an unused one."""
    header = ['' if one == UNUSED else one for one in columns]
    count = len(header)
    is_short = any(header[width:])  # a name, for which the rows have no cell
    if is_short or (width > count and any(any(row[count:]) for row in rows)):
        raise RecordingError(
            f'{name} has {width} columns, and {count} names of columns are given: its first row '
            f'is {_listed(rows[0])}; give a name for each, and {UNUSED} for one that is not used'
        )
    return header


def _left_out(source: Source, block: Block) -> list[str]:
    """Return a note on the lines that are no part of the table."""
    used = {block.names, block.units, *block.rows} - {None}
    left = [i for i in range(source.count) if i not in used] if len(used) < source.count else []
    if not left:
        return []
    starts = [i for i in left if i == 0 or i - 1 in used]
    spans = []
    for start in starts:
        end = start
        while end + 1 < source.count and end + 1 not in used:
            end += 1
        first, last = source.number(start), source.number(end)
        spans.append(f'{first} to {last}' if last > first else f'{first}')
    begin = next((cell for cell in source.cells(left[0]) if cell), '')
    return [
        f'lines that are not part of the table are left out: {_listed(spans)} (the first one '
        f'begins with {begin!r})'
    ]


def _check_header(name: str, header: list[str]) -> None:
    """Raise RecordingError if the names of the columns are not names of columns."""
    if len(header) == 1 and len(header[0].split()) > 1:
        raise RecordingError(
            f'{name} has one column, {header[0]!r}: the first line that is not a comment (#, '
            '% or //) names the columns; separate them by commas, semicolons or tabs'
        )
    named = [one for one in header if one]
    double = sorted({one for one in named if named.count(one) > 1})
    if double:
        raise RecordingError(
            f'{name} has several columns called {double[0]!r}: give names with --columns'
        )


def _check_rows(name: str, table: Table, columns: Sequence[str]) -> None:
    """Give all rows a cell for each column; raise RecordingError for a row that lacks some.

    Spreadsheets write separators for empty cells at the end of some lines, and of others not.
    """
    header, rows, lines = table.header, table.rows, table.lines
    count = len(header)
    named = [i for i, one in enumerate(header) if one]
    if len(named) > 1 and header[named[-1]].lower() == _COMMENT:
        named.pop()
    least = named[-1] + 1 if named else 1
    for end, which in ((-1, 'last line'), (0, 'first line of numbers')):
        if rows and len(rows[end]) < least and (end or len(rows) > 1):
            table.notes.append(f'the {which} ({lines[end]}) is cut off and left out')
            rows.pop(end)
            lines.pop(end)
    for i, row in enumerate(rows):
        if len(row) == count:
            continue
        if len(row) < least or any(row[count:]):
            raise RecordingError(f'{name}, line {lines[i]}: {len(row)} cells for {count} columns')
        rows[i] = [*row, *[''] * (count - len(row))][:count]
    if not rows:
        raise RecordingError(f'{name} has the names of columns, and no row of numbers')
    if columns:
        return
    unnamed = [i for i, one in enumerate(header) if not one and any(row[i] for row in rows)]
    if unnamed:
        which = ', '.join(str(i + 1) for i in unnamed)
        table.notes.append(f'columns without a name are not used: {which} of {count}')


def _listed(cells: Iterable[str]) -> str:
    all_of_them = [*cells]
    more = len(all_of_them) - _SHOWN
    return ', '.join(all_of_them[:_SHOWN]) + (f' and {more} more' if more > 0 else '')
