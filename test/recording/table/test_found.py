# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The table in a file that has more than a table, or no names of columns."""

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.csv_file import read_csv
from pam_ros.recording.mapping import column_names, read_mapping

NAMES = 't_s,pressure_command_kPa,position_mm'
ROWS = '0,100,1.5\n0.01,200,2.5\n0.02,200,3.5\n'
PLAIN = f'{NAMES}\n{ROWS}'
LATER = ROWS.replace('0.0', '0.1').replace('0,1', '0.10,1', 1)
TABS = ROWS.replace('.', ';').replace(',', '\t').replace(';', ',')
LABVIEW = (
    'LabVIEW Measurement\t\nSeparator\tTab\nDate\t2024/05/01\nTime\t10:22:31,524\n'
    '***End_of_Header***\t\n\t\n'
)
SEGMENT = (
    'Channels\t2\t\nSamples\t3\t3\nDate\t2024/05/01\t2024/05/01\nX_Dimension\tTime\tTime\n'
    'Delta_X\t0,01\t0,01\n***End_of_Header***\t\t\nX_Value\tUntitled\tUntitled 1\tComment\n'
)
OF_LABVIEW = ('X_Value=t_s', 'Untitled=pressure_command_kPa', 'Untitled 1=position_mm')
RESULTS = 'Operator,Smith\nSpeed,5\n\nMax load,Strain\nN,%\n10.5,3\n11.5,4\n\n'


def read(path, content, columns='', rules=()):
    (path / 'log.csv').write_text(content, encoding='latin-1')
    names = column_names(columns) if columns else ()
    series, notes, _ = read_csv(path / 'log.csv', read_mapping(rules), names)
    return series, notes


def check(series, again=False):
    times = [0.0, 0.01, 0.02, *([0.1, 0.11, 0.12] if again else [])]
    assert sorted(series) == ['position', 'pressure_command']
    for name, values in (
        ('position', [1.5e-3, 2.5e-3, 3.5e-3]),
        ('pressure_command', [1e5, 2e5, 2e5]),
    ):
        np.testing.assert_allclose(series[name].t, times)
        np.testing.assert_allclose(series[name].value, values * (1 + again))


@pytest.mark.parametrize(
    ('content', 'columns', 'note'),
    [
        (ROWS, NAMES, None),
        (ROWS.replace('\n', ',7\n'), f'{NAMES},-', None),
        (ROWS.replace('\n', ',,\n'), NAMES, None),
        ('a,b,c\n' + ROWS, NAMES, 'those given, and not those of line 1'),
        ('Ready\n' + ROWS, NAMES, "left out: 1 (the first one begins with 'Ready')"),
        ('.5,2\n' + ROWS, NAMES, 'the first line of numbers (1) is cut off and left out'),
        (ROWS.replace('0', 'on,0', 1).replace('\n0', '\non,0'), f'-,{NAMES}', None),
    ],
)
def test_names_that_are_given(tmp_path, content, columns, note):
    series, notes = read(tmp_path, content, columns)
    check(series)
    assert [note in one for one in notes] == [True] * (note is not None)


def test_names_that_are_given_can_have_meanings(tmp_path):
    rules = ['adc=position_mm*0.5']
    series, _ = read(tmp_path, ROWS.replace('.5\n', '\n'), 't_s,pressure_command_kPa,adc', rules)
    np.testing.assert_allclose(series['position'].value, [0.5e-3, 1e-3, 1.5e-3])


@pytest.mark.parametrize(
    ('content', 'rules', 'left_out'),
    [
        ('Ready\nInitialising...\n' + PLAIN, (), "1 to 2 (the first one begins with 'Ready')"),
        ('01,200,2\n' + PLAIN, (), '1 (the'),
        ('.5,2\nReady\n' + PLAIN, (), '1 to 2 (the'),
        (PLAIN.replace('m\n', 'm\nsensor ok\n', 1), (), '2 (the'),
        (PLAIN.replace('m\n', 'm\n5\n', 1), (), '2 (the'),
        (PLAIN.replace('m\n', 'm\n0.\xf0,100,1.5\n', 1), (), '2 (the'),
        (PLAIN + 'End of test\n', (), '5 (the'),
        (RESULTS + PLAIN, (), '1 to 7 (the'),
        (LABVIEW + SEGMENT + TABS, OF_LABVIEW, '1 to 12 (the'),
        ('sep=;\nRig 1\n' + PLAIN.replace(',', ';'), (), '2 (the'),
    ],
)
def test_lines_around_a_table_are_left_out_with_a_note(tmp_path, content, rules, left_out):
    series, notes = read(tmp_path, content, rules=rules)
    check(series)
    note = f'lines that are not part of the table are left out: {left_out}'
    assert any(one.startswith(note) for one in notes)


def test_a_first_line_for_excel_is_understood(tmp_path):
    series, notes = read(tmp_path, 'sep=;\n' + PLAIN.replace(',', ';'))
    check(series)
    assert notes == []


def test_names_in_a_comment(tmp_path):
    series, notes = read(tmp_path, f'# rig 3\n# {PLAIN}')
    check(series)
    assert notes == ['the names of the columns are those of the comment in line 2']


def test_segments_of_one_table_are_joined_in_time(tmp_path):
    later = LATER.replace('.', ';').replace(',', '\t').replace(';', ',')
    content = LABVIEW + SEGMENT + TABS + SEGMENT
    series, notes = read(tmp_path, content + later, rules=OF_LABVIEW)
    check(series, again=True)
    assert any('left out: 1 to 12, 17 to 23 (' in one for one in notes)
    with pytest.raises(RecordingError, match=r'X_Value goes backwards.*two recordings'):
        read(tmp_path, content + TABS, rules=OF_LABVIEW)


@pytest.mark.parametrize(
    ('content', 'columns', 'words'),
    [
        (ROWS, '', ['no line with column names', '0, 100, 1.5 (line 1)', '--columns t_s,']),
        (ROWS, 't_s,force_N', ['has 3 columns, and 2 names', '0, 100, 1.5', '- for one that is']),
        (ROWS, f'{NAMES},force_N', ['has 3 columns, and 4 names']),
        (ROWS, 't_s,,position_mm', ['has an empty name']),
        (ROWS, 't_s,position_mm,t_s', ["several columns called 't_s'"]),
        (f'{PLAIN}\n{PLAIN.replace("kPa", "bar")}', '', ['has 2 tables', '2 to 4', '7 to 9']),
        (PLAIN + 'ERR\n' + LATER, '', ['line 5: 1 cells for 3 columns']),
        (PLAIN + 'fault,open,loose\n' + LATER, '', ["line 5: t_s = 'fault' is not a number"]),
        (f'{NAMES}\n,100,1.5\n,200,2.5\n', '', ["column 't_s' is the time, and it is empty"]),
    ],
)
def test_what_is_refused(tmp_path, content, columns, words):
    with pytest.raises(RecordingError) as caught:
        read(tmp_path, content, columns)
    for word in words:
        assert word in str(caught.value)
