# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""CSV files: the many ways in which they are written, and what is wrong with them."""

import codecs

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.csv_file import read_csv, write_csv
from pam_ros.recording.mapping import ColumnMapping, read_mapping
from pam_ros.recording.recording import Recording

PLAIN = 't_s,pressure_command_kPa,position_mm\n0,100,1.5\n0.01,200,2.5\n0.02,200,3.5\n'


def read(path, content, rules=(), encoding='utf-8'):
    file = path / 'log.csv'
    file.write_bytes(content if isinstance(content, bytes) else content.encode(encoding))
    return read_csv(file, read_mapping(rules) if rules else ColumnMapping())[:2]


def check_plain(series):
    assert sorted(series) == ['position', 'pressure_command']
    np.testing.assert_allclose(series['position'].t, [0.0, 0.01, 0.02])
    np.testing.assert_allclose(series['position'].value, [1.5e-3, 2.5e-3, 3.5e-3])
    np.testing.assert_allclose(series['pressure_command'].value, [1e5, 2e5, 2e5])


@pytest.mark.parametrize(
    'content',
    [
        PLAIN,
        PLAIN.replace('\n', '\r\n'),
        PLAIN.replace(',', ';'),
        PLAIN.replace(',', '\t'),
        PLAIN.replace(',', ', '),
        PLAIN.replace(',', ' ; '),
        PLAIN.replace(',', ';').replace('.', ','),
        PLAIN.replace(',', '\t').replace('.', ','),
        PLAIN.replace('\n', ',\n'),
        PLAIN.replace('\n', ',,,\n'),
        PLAIN.replace('\n', ',,,\n', 1),
        PLAIN.replace('5\n', '5,,\n'),
        PLAIN.replace(',', ',,'),
        ''.join(
            ','.join(f'"{cell}"' for cell in line.split(';')) + '\n'
            for line in PLAIN.replace(',', ';').replace('.', ',').splitlines()
        ),
        '# rig 3, 12 May\n\n# second run\n' + PLAIN.replace('0.01', '# a note\n0.01'),
        '% from a script\n' + PLAIN,
        PLAIN.replace('t_s', '"t_s"').replace('position_mm', '"position [mm]"'),
        PLAIN.replace('t_s', 'Time (s)'),
        codecs.BOM_UTF8 + PLAIN.encode(),
        PLAIN.encode('utf-16'),
        ('# 20 °C\n' + PLAIN).encode('latin-1'),
        PLAIN.replace('t_s', 't_ms').replace('0.01', '10').replace('0.02', '20'),
        PLAIN.replace('t_s', 'stamp_ns').replace('0.01', '1e7').replace('0.02', '2e7'),
    ],
)
def test_ways_to_write_the_same(tmp_path, content):
    series, notes = read(tmp_path, content)
    check_plain(series)
    assert notes == []


def test_columns_with_values_but_no_name_are_noted(tmp_path):
    content = PLAIN.replace('_mm', '_mm,,').replace('.5\n', '.5,,7\n')
    series, notes = read(tmp_path, content)
    check_plain(series)
    assert notes == ['columns without a name are not used: 5 of 5']


def test_the_empty_end_of_a_block_is_left_out(tmp_path):
    series, notes = read(tmp_path, PLAIN.encode() + b'\0' * 400)
    check_plain(series)
    assert notes == ['the file ends with 400 NUL bytes, which are left out']
    # The last line that was written may be cut off.
    series, notes = read(tmp_path, PLAIN.encode() + b'0.03,200,4' + b'\0' * 400)
    check_plain(series)
    assert len(notes) == 2


def test_columns_that_are_not_used_are_named(tmp_path):
    content = PLAIN.replace('_mm', '_mm,temperature,note').replace('.5\n', '.5,20,ok\n')
    series, notes = read(tmp_path, content)
    check_plain(series)
    assert notes == ['columns not used: temperature, note']


def test_columns_that_the_user_leaves_out_are_not_named(tmp_path):
    content = PLAIN.replace('_mm', '_mm,force_lb').replace('.5\n', '.5,20\n')
    with pytest.raises(RecordingError, match=r"log\.csv: column 'force_lb' has the unit 'lb'"):
        read(tmp_path, content)
    series, notes = read(tmp_path, content, ['force_lb=ignore'])
    check_plain(series)
    assert notes == []


def test_other_names_and_scales(tmp_path):
    content = 'clock,u,x\n0,1,-10\n10,2,-20\n20,2,-30\n'
    series, _ = read(
        tmp_path, content, ['clock=t_ms', 'u=pressure_command_bar', 'x=position_mm*-0.1+0.5']
    )
    check_plain(series)


def test_columns_may_have_rates_of_their_own(tmp_path):
    rows = ['t_s,pressure_command_Pa,position_m,pressure_kPa']
    for k in range(400):
        pressure = f'{k / 10}' if k % 10 == 0 else ''
        command = f'{k}' if k % 150 == 0 else ''
        rows.append(f'{k / 1000},{command},{k / 1e5},{pressure}')
    series, notes = read(tmp_path, '\n'.join(rows) + '\n')
    assert notes == []
    assert series['position'].t.size == 400
    np.testing.assert_allclose(series['pressure'].t, np.arange(40) / 100)
    np.testing.assert_allclose(series['pressure'].value, 1e3 * np.arange(40))
    np.testing.assert_allclose(series['pressure_command'].t, [0.0, 0.15, 0.3])


@pytest.mark.parametrize('cell', ['', 'nan', 'NaN', 'NA', 'null'])
def test_a_stretch_of_missing_positions_is_refused(tmp_path, cell):
    rows = [f'{k / 100},{k},{cell if 100 <= k < 180 else k / 1e5}' for k in range(400)]
    with pytest.raises(RecordingError, match=r'position_m has no values from 0.99 s to 1.8 s'):
        read(tmp_path, '\n'.join(['t_s,pressure_command_Pa,position_m', *rows]))


def test_a_stretch_of_missing_commands_in_a_full_column_is_refused(tmp_path):
    rows = [f'{k / 100},{"" if 100 <= k < 180 else k},{k / 1e5}' for k in range(400)]
    with pytest.raises(RecordingError, match='pressure_command_Pa has no values'):
        read(tmp_path, '\n'.join(['t_s,pressure_command_Pa,position_m', *rows]))


@pytest.mark.parametrize(
    ('content', 'words'),
    [
        ('', ['empty']),
        ('# nothing\n', ['empty']),
        ('0,1,2\n1,2,3\n', ['column names', '0, 1, 2']),
        ('0,0,,,0\n1,0,,,3\n', ['no line with column names']),
        (',,\n1,2,3\n', ['no line with column names']),
        (PLAIN.replace('1.5', '1.5,,9'), ['line 2', '5 cells for 3 columns']),
        (b'0\0' * 9, ['not a text file']),
        (PLAIN.replace('t_s', 'x'), ['no time axis', "'t_s'", 'pressure_command_kPa']),
        (PLAIN.replace('t_s', 'timestamp'), ['timestamp', 'no unit', 't_s']),
        (PLAIN.replace('_kPa', ''), ['pressure_command', 'no unit']),
        (PLAIN.splitlines()[0] + '\n', ['the names of columns, and no row']),
        (PLAIN.replace(',', ' '), ['has one column', 'separate them by commas']),
        (PLAIN.replace('_kPa', '_inAq'), ['inAq', 'bar', 'pressure_command_Pa*FACTOR']),
        (PLAIN.replace('2.5', 'bad'), ['line 3', 'position_mm', "'bad'", 'not a number']),
        (PLAIN.replace('2.5', '1.2.3'), ['line 3', "'1.2.3'"]),
        (PLAIN.replace('2.5', 'inf'), ['position_mm', 'infinite', '0.01 s']),
        (PLAIN.replace('2.5', '2,5'), ['line 3', '4 cells', '3 columns']),
        (PLAIN.replace('0.01,200', '0.01'), ['line 3', '2 cells']),
        (PLAIN.replace('0.01', ''), ['line 3', 'without a time']),
        (PLAIN.replace('0.02', '0.005'), ['t_s goes backwards', '0.005 s after 0.01 s']),
        (PLAIN.replace('position_mm', 'time [ms]'), ["'t_s'", "'time [ms]'", 'time']),
        (PLAIN.replace('position_mm', 't_s'), ["several columns called 't_s'"]),
        (b'\x89PNG\r\n\x00\x00\x01', ['not a text file']),
        (PLAIN.replace('0.01', '"0.01'), ['line 3', 'quotation mark is not closed']),
        (PLAIN.replace('0.01', '"0.01\n"'), ['line 3', 'quotation mark is not closed']),
        (PLAIN.replace('t_s', '"t_s'), ['line 1', 'quotation mark is not closed']),
        (PLAIN.encode('utf-16') + b'0', ['not UTF-16', 'truncated data']),
        (codecs.BOM_UTF16_LE + b'\0\xd8' * 9, ['not UTF-16', 'surrogate']),
        (codecs.BOM_UTF16_BE + PLAIN.encode('utf-16-le'), ['the other byte order']),
        (codecs.BOM_UTF16_LE + PLAIN.encode('utf-16-be'), ['the other byte order']),
        (PLAIN.encode('utf-32'), ['not a text file']),
    ],
)
def test_what_is_refused(tmp_path, content, words):
    with pytest.raises(RecordingError) as caught:
        read(tmp_path, content)
    assert 'log.csv' in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def test_a_last_line_with_too_few_cells_is_left_out(tmp_path):
    series, notes = read(tmp_path, PLAIN + '0.03,2\n')
    check_plain(series)
    assert notes == ['the last line (5) is cut off and left out']


@pytest.mark.parametrize('last', ['0.03,2', '0.03,200,', '0.03,200,-', '0.03,200,4.', '0.0', '"0'])
def test_a_last_line_without_a_line_break_is_left_out(tmp_path, last):
    series, (note,) = read(tmp_path, PLAIN + last)
    check_plain(series)
    assert note.startswith('the last line (5) does not end with a line break')


def test_a_cell_that_is_too_long(tmp_path):
    with pytest.raises(RecordingError, match=r'line 3: a cell is longer than 131072'):
        read(tmp_path, PLAIN.replace('0.01', '1' * 140_000))


def test_a_mapped_column_that_is_not_there(tmp_path):
    with pytest.raises(RecordingError, match="no 'volts'"):
        read(tmp_path, PLAIN, ['volts=pressure_command_Pa'])


def test_an_empty_column_is_noted(tmp_path):
    content = PLAIN.replace('_mm', '_mm,force_N').replace('.5\n', '.5,\n')
    series, notes = read(tmp_path, content)
    check_plain(series)
    assert notes == ['column force_N is empty']


def test_what_is_written_reads_back_to_the_same_numbers(tmp_path):
    rng = np.random.default_rng(3)
    t = np.cumsum(rng.uniform(0.5e-3, 2e-3, 300))
    command_t = np.sort(np.append(rng.uniform(-0.1, t[-1], 19), t[100]))
    recording = Recording(
        name='made',
        t=t,
        command_t=command_t,
        command=rng.uniform(0.0, 6e5, 20),
        position=rng.normal(size=300),
        velocity=None,
        force=rng.normal(size=300),
        pressure=rng.normal(size=300),
        kind='free',
    )
    file = tmp_path / 'made.csv'
    write_csv(recording, file)
    assert [path.name for path in tmp_path.iterdir()] == ['made.csv']
    series, notes, _ = read_csv(file, ColumnMapping())
    assert notes == []
    for name in ('position', 'force', 'pressure'):
        np.testing.assert_array_equal(series[name].t, t)
        np.testing.assert_array_equal(series[name].value, getattr(recording, name))
    np.testing.assert_array_equal(series['pressure_command'].t, command_t)
    np.testing.assert_array_equal(series['pressure_command'].value, recording.command)


def test_a_file_that_cannot_be_written(tmp_path):
    t = np.arange(3.0)
    recording = Recording('made', t, None, None, t, None, None, t, 'free')
    with pytest.raises(RecordingError, match='cannot be written'):
        write_csv(recording, tmp_path / 'nowhere' / 'made.csv')
