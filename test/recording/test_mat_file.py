# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""MATLAB files are read as the tables with the same columns."""

import numpy as np
import pytest
import scipy.io
from scipy.io.matlab import MatlabOpaque

from pam_ros.errors import RecordingError
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.table_file import read_table_file

T = 0.01 * np.arange(40)
COLUMNS = {'t_s': T, 'pressure_command_kPa': 100.0 + T, 'position_mm': np.sin(T)}
NAMES = (*COLUMNS, '-')
MATRIX = np.column_stack([*COLUMNS.values(), np.ones(40)])
ROWS = np.array([tuple(row) for row in MATRIX[:, :3]], dtype=[(name, float) for name in COLUMNS])


def read(path, values, *given):
    scipy.io.savemat(path / 'log.mat', values)
    return read_table_file(path / 'log.mat', ColumnMapping(), *given)[:2]


@pytest.mark.parametrize(
    ('values', 'given'),
    [
        (COLUMNS, ()),
        ({name: one[:, np.newaxis] for name, one in COLUMNS.items()}, ()),
        ({'run': COLUMNS, 'mass': 20.0, 'rig': 'bench 3'}, ()),
        ({'run': ROWS}, ()),
        ({'run': COLUMNS, 'other': {'x': T, 'y': T}}, ((), None, 'run')),
        ({'data': MATRIX}, (NAMES,)),
        ({'data': MATRIX.T, 'gains': np.ones((3, 3))}, (NAMES,)),
        ({'data': MATRIX, 'more': 2.0 * MATRIX}, (NAMES, None, 'data')),
    ],
)
def test_the_columns_of_a_file(tmp_path, values, given):
    series, notes = read(tmp_path, values, *given)
    assert notes == []
    assert sorted(series) == ['position', 'pressure_command']
    np.testing.assert_allclose(series['position'].t, T)
    np.testing.assert_allclose(series['position'].value, 1e-3 * np.sin(T))
    np.testing.assert_allclose(series['pressure_command'].value, 1e3 * (100.0 + T))


def test_short_vectors_are_noted(tmp_path):
    _, notes = read(tmp_path, {**COLUMNS, 'gains': np.ones(3)})
    assert notes == ['vectors with fewer than 40 values are not used: gains (3)']


@pytest.mark.parametrize(
    ('values', 'given', 'words'),
    [
        ({'a': COLUMNS, 'b': COLUMNS}, (), ['has a, b: choose one struct with --variable']),
        ({'a': COLUMNS}, ((), None, 'c'), ["no variable 'c': it has a"]),
        ({'data': MATRIX}, (), ['data (40 by 4)', '--columns']),
        ({'data': MATRIX}, (NAMES[:3],), ['data (40 by 4), and 3 names']),
        ({'a': MATRIX, 'b': MATRIX}, (NAMES,), ['choose one with --variable']),
        ({'mass': 20.0}, (), ['has no vectors: it has mass', '-v7']),
        ({**COLUMNS, 't_s': T[::-1]}, (), ['goes backwards']),
        (COLUMNS, ((), 'a'), ['is not an Excel workbook']),
    ],
)
def test_what_is_refused(tmp_path, values, given, words):
    with pytest.raises(RecordingError) as caught:
        read(tmp_path, values, *given)
    for word in words:
        assert word in str(caught.value)


def test_files_that_are_not_read(tmp_path, monkeypatch):
    file = tmp_path / 'log.mat'
    file.write_bytes(b'MATLAB 7.3 MAT-file'.ljust(124) + b'\x00\x02IM' + b'\x89HDF' * 99)
    with pytest.raises(RecordingError, match=r'log\.mat is a MATLAB file of version 7\.3'):
        read_table_file(file, ColumnMapping())
    file.write_text('t_s,position_mm\n')
    with pytest.raises(RecordingError, match=r'log\.mat is not a valid MATLAB file'):
        read_table_file(file, ColumnMapping())
    # scipy reads an object of MATLAB, such as a timeseries, as this, and cannot write one.
    opaque = {'None': np.zeros(1).view(MatlabOpaque), '__function_workspace__': np.zeros(9)}
    monkeypatch.setattr(scipy.io, 'loadmat', lambda *_, **__: opaque)
    with pytest.raises(RecordingError, match='a timetable or a timeseries, which only MATLAB'):
        read_table_file(file, ColumnMapping())
