# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A file with a table, whose suffix tells its format."""

from collections.abc import Sequence
from pathlib import Path

from pam_ros.errors import RecordingError
from pam_ros.recording.csv_file import read_csv, series_of_table
from pam_ros.recording.dataframe import series_of_frame
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.mat_file import read_mat
from pam_ros.recording.series import Series
from pam_ros.recording.table.workbook import SUFFIXES, read_workbook


def read_table_file(
    path: Path,
    mapping: ColumnMapping,
    columns: Sequence[str] = (),
    sheet: str | None = None,
    variable: str | None = None,
) -> tuple[dict[str, Series], list[str], list[str]]:
    """Return (signal -> series in SI, warnings, names of the columns) of the file at *path*.

    It is an Excel workbook, of which *sheet* is read, a MATLAB file, of which *variable* is read,
    or a text file. *columns* are the names of its columns if they are given. Raises RecordingError
    if the file cannot be read.
    """
    suffix = path.suffix.lower()
    if sheet is not None and suffix not in SUFFIXES:
        raise RecordingError(
            f'sheet = {sheet}, but {path.name} is not an Excel workbook (.xlsx): leave it out'
        )
    if variable is not None and suffix != '.mat':
        raise RecordingError(
            f'variable = {variable}, but {path.name} is not a MATLAB file (.mat): leave it out'
        )
    if suffix in SUFFIXES:
        table = read_workbook(path, mapping, columns, sheet)
        return series_of_table(path.name, table, mapping)
    if suffix == '.mat':
        frame = read_mat(path, columns, variable)
        series, notes, header = series_of_frame(path.name, frame, mapping)
        return series, frame.notes + notes, header
    if suffix == '.xls':
        raise RecordingError(
            f'{path.name} is a workbook of an old format: save it as .xlsx or as CSV'
        )
    return read_csv(path, mapping, columns)
