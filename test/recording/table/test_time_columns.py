# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Times that are written as dates and clock times."""

from datetime import datetime, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.errors import RecordingError
from pam_ros.recording.csv_file import read_csv
from pam_ros.recording.mapping import read_mapping
from pam_ros.recording.table.time_stamps import seconds

FORMATS = (
    '%Y-%m-%d %H:%M:%S.%f',
    '%Y-%m-%dT%H:%M:%S,%f',
    '%Y-%m-%dT%H:%M:%S.%fZ',
    '%d.%m.%Y %H:%M:%S.%f',
    '%m/%d/%Y %I:%M:%S.%f %p',
    '%m/%d/%y %H:%M:%S:%f',
    '%d-%b-%Y %H:%M:%S.%f',
    '%H:%M:%S.%f',
    '%I:%M:%S.%f %p',
)
DAYS = st.datetimes(datetime(2001, 1, 1), datetime(2099, 12, 1))


def read(path, names, cells, rules=(), separator=','):
    head = separator.join((names, 'pressure_command_kPa', 'position_mm'))
    rows = [separator.join((cell, str(i), f'{i}')) for i, cell in enumerate(cells)]
    (path / 'log.csv').write_text('\n'.join([head, *rows, '']), encoding='utf-8')
    series, notes, _ = read_csv(path / 'log.csv', read_mapping(rules))
    return series['position'].t, notes


@given(DAYS, st.sampled_from(FORMATS), st.sampled_from([1e-3, 0.5, 7.0, 3600.0]))
def test_times_of_any_format_keep_their_microseconds_past_midnight(first, form, step):
    t = [round(i * step, 6) for i in range(40)]
    cells = [(first + timedelta(seconds=one)).strftime(form) for one in t]
    np.testing.assert_allclose(seconds('time', cells), t, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize(
    ('names', 'cells', 'expected'),
    [
        ('Time', ['59:59.9', '00:00.1', '00:00.3'], [0.0, 0.2, 0.4]),
        ('timestamp', ['2024-05-01T01:59:59+02:00', '2024-05-01T01:00:00.5+0100'], [0.0, 1.5]),
        ('Date,Time', ['05/01/2024,23:59:59.9', '06/01/2024,00:00:00.1'], [0.0, 0.2]),
        ('Date,Time', ['2024-05-01,0.1', '2024-05-01,0.2'], [0.1, 0.2]),
        ('timestamp,t_s', ['10:22:31.1,0.1', '10:22:31.2,0.3'], [0.1, 0.3]),
        ('calibrated,time', ['2020-01-01,10:22:31.1', '2020-01-01,10:22:31.2'], [0.0, 0.1]),
    ],
)
def test_the_column_of_the_times(tmp_path, names, cells, expected):
    np.testing.assert_allclose(read(tmp_path, names, cells)[0], expected, atol=1e-9)


def test_another_name_and_a_decimal_comma(tmp_path):
    cells = ['10:22:31,123', '10:22:31,133']
    t, notes = read(tmp_path, 'Zeit', cells, ['Zeit=t_s'], ';')
    np.testing.assert_allclose(t, [0.0, 0.01], atol=1e-9)
    assert notes == []


@pytest.mark.parametrize(
    ('names', 'cells', 'words'),
    [
        (
            'Time',
            ['10:22:31'] * 5 + ['10:22:32'] * 5,
            ['whole seconds', '8 of 10', 'hh:mm:ss.000'],
        ),
        ('Time', ['2024-05-01 10:22', '2024-05-01 10:23'], ['line 2', 'hours, minutes and sec']),
        ('Time', ['10:22', '10:23'], ['line 2', 'hours, minutes and seconds']),
        ('Time', ['10:22:31.1', '10:62:31.2'], ["line 3: Time = '10:62:31.2' is not a time of"]),
        ('Time', ['10:22:31.1', '13:22:31.2 PM'], ['line 3', 'AM or PM']),
        ('Time', ['10:22:31.1', 'oops'], ['line 3', 'is not a clock time']),
        ('Time', ['10:22:31.1', '', '10:22:31.2'], ['line 3: a row without a time']),
        ('Time', ['10:22:31.1', '10:22:31.0'], ['Time goes backwards']),
        ('Time', ['12:59:59.9', '01:00:00.1'], ['Time goes backwards']),
        ('date', ['31/12/2024 1:00:00', '12/31/2024 1:00:01'], ['line 3', 'order of the others']),
        ('date', ['2024-02-30 1:00:00', '2024-02-30 1:00:01'], ['line 2', 'date']),
        ('time', ['2024-05-01 1:00:00Z', '2024-05-01 1:00:01'], ['line 3', 'offset']),
        (
            'Time A,Time B',
            ['1:00:00,1:00:00', '1:00:01,1:00:01'],
            ['both give the time', 'ignore'],
        ),
    ],
)
def test_what_is_refused(tmp_path, names, cells, words):
    with pytest.raises(RecordingError) as caught:
        read(tmp_path, names, cells)
    for word in words:
        assert word in str(caught.value)
