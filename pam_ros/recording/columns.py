# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The columns of a table, whose names contain the unit, as series."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError
from pam_ros.recording.likely import found_columns
from pam_ros.recording.mapping import ColumnMapping, Meaning
from pam_ros.recording.series import Series, refuse_backwards

Array = NDArray[np.float64]
Columns = dict[str, tuple[int, Meaning]]  # signal -> number of its column, and what it means
DENSE = 0.5  # a command column with at least this share of filled cells must have no holes


def chosen(name: str, header: list[str], mapping: ColumnMapping) -> tuple[Columns, list[str]]:
    """Return signal -> (column, meaning), and the note on columns that are not used."""
    columns: Columns = {}
    unused = []
    for index, column in enumerate(header):
        if not column:
            continue
        try:
            meaning = mapping.meaning(column)
        except RecordingError as error:
            raise RecordingError(f'{name}: column {error}') from error
        if meaning is None:
            if column not in mapping:
                unused.append(column)
            continue
        key = meaning.target.key
        if key in columns:
            other = header[columns[key][0]]
            raise RecordingError(
                f'{name}: columns {other!r} and {column!r} both give the {key}: leave one '
                f"out with --column '{column}=ignore'"
            )
        columns[key] = (index, meaning)
    notes = [f'columns not used: {", ".join(unused)}'] if unused else []
    return columns, notes


def to_series(
    name: str,
    header: list[str],
    mapping: ColumnMapping,
    columns: Columns,
    values: dict[str, Array],
    notes: list[str],
    row: Callable[[int], str],
) -> tuple[dict[str, Series], list[str]]:
    """Return (signal -> series, warnings) of the *values* (n,) in SI of the chosen *columns*.

    NaN is an empty cell. *notes* are the warnings so far, and row(i) is what an error calls the
    row i. Raises RecordingError for a table without a time axis, a row without a time, and a time
    that goes back.
    """
    if 'time' not in columns:
        raise RecordingError(
            f"{name} has no time axis: name a column 't_s' (or t_ms, time_s, timestamp_ns), "
            f"or map one with --column 'NAME=t_s'; {found_columns(header, mapping, columns)}"
        )
    values = dict(values)
    t = values.pop('time')
    known = np.isfinite(t)
    if not known.any():
        raise RecordingError(
            f'{name}: column {header[columns["time"][0]]!r} is the time, and it is empty: save '
            'the recording with the time of each row'
        )
    if not known.all():
        raise RecordingError(f'{name}, {row(int(np.argmin(known)))}: a row without a time')
    refuse_backwards(t, f'{name}: {header[columns["time"][0]]}')
    series: dict[str, Series] = {}
    for signal, value in values.items():
        source = header[columns[signal][0]]
        present = np.isfinite(value)
        if not present.any():
            notes = [*notes, f'column {source} is empty']
            continue
        is_command = columns[signal][1].target.quantity == 'pressure_command'
        if is_command and present.mean() < DENSE:
            series[signal] = Series(source, t[present], value[present])
        else:
            series[signal] = Series.taken(name, source, t, value)
    return series, notes
