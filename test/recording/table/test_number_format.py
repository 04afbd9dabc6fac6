# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Decimal marks and marks of thousands are found for whole columns."""

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.table.number_format import UnreadableCellError, is_number, numbers

NBSP, THIN, QUOTE = (
    '\N{NO-BREAK SPACE}',
    '\N{NARROW NO-BREAK SPACE}',
    '\N{RIGHT SINGLE QUOTATION MARK}',
)


@pytest.mark.parametrize(
    ('cells', 'expected'),
    [
        # A decimal comma, where a group of three digits cannot be meant.
        (['0,00', '0,01'], [0.0, 0.01]),
        (['100,5', '-1,25e-3'], [100.5, -1.25e-3]),
        (['0,123', '0,456'], [0.123, 0.456]),
        (['1,204', '1500'], [1.204, 1500.0]),  # marks would be in both
        # Marks of thousands.
        (['987', '1,204'], [987.0, 1204.0]),
        (['1,204.5', '987.5', '+1,204,500'], [1204.5, 987.5, 1204500.0]),
        (['1.204,5', '987,5'], [1204.5, 987.5]),
        (["1'204.5", f'12{QUOTE}204'], [1204.5, 12204.0]),
        ([f'1{NBSP}204,5', f'2{THIN}204{THIN}500'], [1204.5, 2204500.0]),
        # Points alone are decimal points.
        (['1.204', '987'], [1.204, 987.0]),
        (['.5', '5.', '1e3', '-INF'], [0.5, 5.0, 1e3, -np.inf]),
        (['', 'NaN', 'n/a', '1,5'], [np.nan, np.nan, np.nan, 1.5]),
    ],
)
def test_a_column_alone(cells, expected):
    np.testing.assert_array_equal(numbers('log.csv', {'x': cells})['x'], expected)


@pytest.mark.parametrize(
    ('other', 'cells', 'expected'),
    [
        (['0.00', '0.01'], ['1,056', '1,055'], [1056.0, 1055.0]),
        (['0,00', '0,01'], ['1,056', '1,055'], [1.056, 1.055]),
        (['0,00', '0,01'], ['1.056', '987'], [1056.0, 987.0]),
        (['0,00', '0,01'], ['1.25', '987'], [1.25, 987.0]),
        (['0', '1'], ['1.056', '987'], [1.056, 987.0]),
    ],
)
def test_the_other_columns_of_the_file_decide(other, cells, expected):
    found = numbers('log.csv', {'t': other, 'x': cells})
    np.testing.assert_array_equal(found['x'], expected)
    np.testing.assert_array_equal(found['t'], [float(cell.replace(',', '.')) for cell in other])


def test_a_column_with_two_readings_is_refused_with_both():
    with pytest.raises(
        RecordingError, match=r'log.csv: x = 1,204 can be 1204 or 1\.204, like all'
    ):
        numbers('log.csv', {'t': ['0', '1'], 'x': ['1,204', '1,305']})


@pytest.mark.parametrize(
    ('cells', 'row'),
    [
        (['1.5', 'bad', '2.5'], 1),
        (['1.5', '2,5'], 1),
        (['1', '1.2.3'], 1),
        (['1,2,3', '1'], 0),
        (['12 34', '1'], 0),
        (['5 mm', '1'], 0),
        (['1,5', '-'], 1),
        (['1,5', '+NA'], 1),
    ],
)
def test_a_cell_that_is_no_number_is_named(cells, row):
    with pytest.raises(UnreadableCellError, match='is not a number') as caught:
        numbers('log.csv', {'x': cells})
    assert caught.value.row == row
    assert repr(cells[row]) in str(caught.value)


def test_names_of_columns_are_no_numbers():
    assert [*map(is_number, ['t_s', '', 'x1', '0', '1,5', '1 204', '-2e5'])] == [
        *[False] * 3,
        *[True] * 4,
    ]
