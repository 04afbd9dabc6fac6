# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Take the columns of a DataFrame, whose names contain the unit, as series."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pam_ros.arguments import refuse
from pam_ros.errors import RecordingError, shown
from pam_ros.recording.columns import chosen, to_series
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.series import Series

Array = NDArray[np.float64]
SECOND = np.timedelta64(1, 's')


def series_of_frame(
    name: str, frame: Any, mapping: ColumnMapping
) -> tuple[dict[str, Series], list[str], list[str]]:
    """Return (signal -> series in SI, warnings, names of the columns) of a DataFrame.

    *frame* has ``columns``, each of which ``frame[column]`` returns: that of pandas, or another
    with these. Columns are read as those of a CSV file, NaN as an empty cell. An index with a name
    is a column, too, and an index of dates is the time, unless a column is.

    Raises RecordingError for a column that does not contain numbers, and ParameterError if *frame*
    is not a DataFrame.
    """
    if not (hasattr(frame, 'columns') and hasattr(frame, '__getitem__')):
        refuse('frame', frame, 'a DataFrame, such as that of pandas')
    cells = {str(column): _values(frame[column]) for column in frame.columns}
    if len(cells) < len(frame.columns):
        raise RecordingError(f'{name} has several columns of one name')
    index = getattr(frame, 'index', None)
    if index is not None:
        of_index = _values(index)
        is_date = of_index.dtype.kind in 'mM'
        title = 't_s' if is_date or index.name is None else str(index.name)
        if (is_date or index.name is not None) and title not in cells:
            cells = {title: of_index, **cells}
    header = list(cells)
    mapping.need(header, name)
    columns, notes = chosen(name, header, mapping)
    values = {}
    for signal, (number, meaning) in columns.items():
        column = _numbers(name, header[number], cells[header[number]])
        factor, offset = meaning.to_si
        values[signal] = column * factor + offset
    return *to_series(name, header, mapping, columns, values, notes, 'row {}'.format), header


def _values(column: Any) -> Any:
    """Return a column as an array (n,); dates with a time zone are those of UTC.

    A missing value, which some types of columns store as a mask, is NaN.
    """
    kind = getattr(column, 'dtype', None)
    has_zone = getattr(kind, 'tz', None) is not None
    if hasattr(kind, 'na_value') and getattr(kind, 'kind', '') in ('i', 'u', 'f', 'b'):
        return column.to_numpy(dtype=np.float64, na_value=np.nan)
    return np.asarray(column, dtype='datetime64[ns]' if has_zone else None)


def _numbers(name: str, column: str, cells: Any) -> Array:
    """Return a column as numbers (n,); dates and durations in s since the first."""
    if cells.dtype.kind in 'mM':
        found: Array = (cells - cells[:1]) / SECOND
        return found
    try:
        return np.asarray(cells, dtype=np.float64)
    except (TypeError, ValueError):
        kind = shown(str(cells.dtype))
        raise RecordingError(
            f'{name}: column {shown(column)} has values that are not numbers ({kind})'
        ) from None
