# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Excel workbooks are read as the CSV files with the same cells."""

import sys
from datetime import datetime, time, timedelta

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.read import read_recording
from pam_ros.recording.table_file import read_table_file

openpyxl = pytest.importorskip('openpyxl')
NAMES = ['t_s', 'pressure_command_kPa', 'position_mm']
ROWS = [[0, 100, 1.5], [0.01, 200, 2.5], [0.02, 200, 3.125]]


def write(path, **sheets):
    book = openpyxl.Workbook()
    book.remove(book.active)
    for title, rows in sheets.items():
        sheet = book.create_sheet(title)
        for row in rows:
            sheet.append(row)
    book.save(path / 'log.xlsx')
    return path / 'log.xlsx'


def read(file, *given):
    return read_table_file(file, ColumnMapping(), *given)[:2]


def check(series):
    assert sorted(series) == ['position', 'pressure_command']
    np.testing.assert_allclose(series['position'].t, [0.0, 0.01, 0.02], atol=1e-9)
    np.testing.assert_allclose(series['position'].value, [1.5e-3, 2.5e-3, 3.125e-3])
    np.testing.assert_allclose(series['pressure_command'].value, [1e5, 2e5, 2e5])


def timed(*times):
    return [['time', *NAMES[1:]], *([t, *row[1:]] for t, row in zip(times, ROWS, strict=True))]


MOMENT = datetime(2024, 5, 1, 23, 59, 59, 990_000)


@pytest.mark.parametrize(
    'rows',
    [
        [NAMES, *ROWS],
        [['Rig 3'], [], ['time', 'pressure_command', 'position'], ['s', 'kPa', 'mm'], *ROWS],
        # A text with a decimal comma in a column does not change what numbers are.
        [[*NAMES, 'force_N'], *([*row, '1,25'] for row in ROWS)],
        timed(*(MOMENT + timedelta(milliseconds=10 * i) for i in range(3))),
        timed(time(23, 59, 59, 990_000), time(0), time(0, 0, 0, 10_000)),
        timed(*(timedelta(hours=30, milliseconds=10 * i) for i in range(3))),
    ],
)
def test_a_sheet(tmp_path, rows):
    series, _ = read(write(tmp_path, data=rows, notes=[['by me']]))
    series.pop('force', None)
    check(series)


def test_an_empty_cell_is_a_sample_that_was_not_taken(tmp_path):
    series, _ = read(write(tmp_path, data=[NAMES, *ROWS, [0.03, None, 4.5], [0.04, None, 5.5]]))
    np.testing.assert_allclose(series['position'].t, [0.0, 0.01, 0.02, 0.03, 0.04])
    np.testing.assert_allclose(series['pressure_command'].t, [0.0, 0.01, 0.02])


def test_a_sheet_that_is_chosen_without_names(tmp_path):
    file = write(tmp_path, first=[['a', 'b'], [1, 2]], second=ROWS)
    check(read(file, NAMES, 'second')[0])
    with pytest.raises(
        RecordingError, match=r"2 sheets with numbers, 'first', 'second': .*--sheet"
    ):
        read(file)
    with pytest.raises(RecordingError, match=r"has no sheet 'third': it has 'first', 'second'"):
        read(file, (), 'third')


@pytest.mark.parametrize(
    ('rows', 'words'),
    [
        (
            [NAMES, [0, 100, 1.5], [0.01, 200, '=A3*2']],
            ['line 3: position_mm is the formula =A3*2'],
        ),
        ([NAMES, [0, 100, 1.5], [0.01, 200, 'bad']], ["line 3: position_mm = 'bad'"]),
        ([['by me']], ['no sheet with rows of numbers']),
        (ROWS, ['no line with column names', '--columns']),
    ],
)
def test_what_is_refused(tmp_path, rows, words):
    with pytest.raises(RecordingError) as caught:
        read(write(tmp_path, data=rows))
    for word in words:
        assert word in str(caught.value)


def test_files_that_are_no_workbooks(tmp_path, monkeypatch):
    file = tmp_path / 'log.xlsx'
    file.write_text('t_s,position_mm\n')
    with pytest.raises(RecordingError, match=r'log\.xlsx is not a valid \.xlsx workbook'):
        read_recording(file)
    with pytest.raises(RecordingError, match=r'sheet = a, but log\.csv is not an Excel workbook'):
        read(tmp_path / 'log.csv', (), 'a')
    with pytest.raises(RecordingError, match=r'old format: save it as \.xlsx'):
        read(tmp_path / 'log.xls')
    monkeypatch.setitem(sys.modules, 'openpyxl', None)
    with pytest.raises(RecordingError, match='openpyxl, which reads it, is not installed'):
        read(file)
