# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What columns with other names probably mean: a sentence proposes, and its options are read."""

import re
import shlex

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.likely import found_columns, likely_target
from pam_ros.recording.mapping import ColumnMapping, read_mapping
from pam_ros.recording.read import read_recording
from support.pages import DOCS, text_of


@pytest.mark.parametrize(
    ('name', 'meaning'),
    [
        ('p_cmd[bar]', 'pressure_command_bar'),
        ('p_cmd [bar]', 'pressure_command_bar'),
        ('pCmd (kPa)', 'pressure_command_kPa'),
        ('p_set_bar', 'pressure_command_bar'),
        ('desired_pressure_mbar', 'pressure_command_mbar'),
        ('u[Pa]', 'pressure_command_Pa'),
        ('p1[bar]', 'pressure_bar'),
        ('chamber_pressure_kPa', 'pressure_kPa'),
        ('pos_mm', 'position_mm'),
        ('x [m]', 'position_m'),
        ('Displacement(mm)', 'position_mm'),
        ('theta_deg', 'angle_deg'),
        ('q[rad]', 'angle_rad'),
        ('kappa[%]', 'contraction_percent'),
        ('load_cell_N', 'force_N'),
        ('F[kN]', 'force_kN'),
        ('time_since_start_ms', 't_ms'),
        ('flexor.p_cmd[bar]', 'flexor.pressure_command_bar'),
    ],
)
def test_a_word_and_a_unit_propose_a_meaning(name, meaning):
    assert str(likely_target(name)) == meaning


@pytest.mark.parametrize(
    'name',
    [
        'p_cmd',
        'adc',
        'temperature_K',
        'mass_kg',
        'pump_N',  # a unit without a word of its quantity
        'position_bar',  # a word with the unit of another quantity
        'sample_time',
        'flexor.pos_mm',  # a position is not that of one muscle
        '',
        '[bar]',
    ],
)
def test_other_names_propose_nothing(name):
    assert likely_target(name) is None


def test_signals_that_were_read_and_columns_that_were_named_are_not_proposed():
    header = ['t_s', 'p_cmd[bar]', 'pos_raw_mm', 'angle_raw_deg', 'F[N]']
    named = read_mapping(['F[N]=ignore'])
    found = found_columns(header, named, {'position'})
    assert re.findall(r'--column (\S+)', found) == ["'p_cmd[bar]=pressure_command_bar'"]


def test_columns_of_one_meaning_are_alternatives():
    found = found_columns(['p1_bar', 'adc', 'p2_bar'], ColumnMapping(), ())
    assert found.endswith('--column p1_bar=pressure_bar or --column p2_bar=pressure_bar')
    found = found_columns(['x_raw_mm', 'theta_raw_deg'], ColumnMapping(), ())
    assert '=position_mm or --column' in found


def test_an_absolute_pressure_becomes_one_above_ambient():
    found = found_columns(['p_abs[kPa]', 'pos_mm'], ColumnMapping(), ())
    assert "--column 'p_abs[kPa]=pressure_kPa-101.325'" in found


def test_positions_of_several_joints_are_refused_with_what_to_do():
    header = ['t_s', 'p.pressure_command_kPa', 'left.position_rad', 'right.position_rad']
    found = found_columns(header, ColumnMapping(), {'time', 'p.pressure_command'})
    assert 'use left.position_rad or right.position_rad' in found
    assert '--column left.position_rad=position_rad' in found
    assert 'one joint' not in found_columns(header, ColumnMapping(), {'angle'})
    other = ['left.pressure_kPa', 'left.contraction_percent', 'left.of.position_m']
    assert 'one joint' not in found_columns(other, ColumnMapping(), ())


def test_many_columns_are_counted():
    header = [f'channel_{i}' for i in range(40)]
    found = found_columns(header, ColumnMapping(), ())
    assert found.endswith("'channel_11' and 28 more")


def written(path, names):
    """Write a recording with columns of these names for time, command, position and force."""
    t = np.arange(0.0, 12.0, 0.02)
    command = 2.0 + np.sin(t) + (t > 6.0)
    force = 150.0 + np.cos(t)
    table = np.stack([t, command, 20.0 + 5.0 * np.sin(t - 0.2), force], axis=1)
    np.savetxt(path, table, delimiter=',', header=','.join(names), comments='')
    return path


@pytest.mark.parametrize(
    ('names', 'kind', 'missing'),
    [
        (('t_s', 'p_cmd[bar]', 'position_mm', 'force_N'), None, 'neither pressure_command nor'),
        (('t_s', 'p_cmd[bar]', 'pos [mm]', 'F[N]'), None, 'neither pressure_command nor'),
        (('t_s', 'pressure_bar', 'pos_mm', 'force_N'), None, 'no position or contraction'),
        (('t_s', 'pressure_bar', 'position_mm', 'cell_force[N]'), 'held', 'no force'),
        (('time_raw_s', 'u[bar]', 'pos_mm', 'F_load_N'), None, 'no time axis'),
    ],
)
def test_the_options_of_the_sentence_make_the_file_readable(tmp_path, names, kind, missing):
    file = written(tmp_path / 'bench.csv', names)
    with pytest.raises(RecordingError, match=f'bench.csv has {missing}') as refused:
        read_recording(file, kind=kind)
    sentence = str(refused.value)
    assert f'its columns are {", ".join(map(repr, names))}: say what they are' in sentence
    words = shlex.split(sentence.partition('say what they are with ')[2])
    assert words[::2] == ['--column'] * (len(words) // 2)
    recording = read_recording(file, mapping=read_mapping(words[1::2]), kind=kind)
    assert recording.position.max() == pytest.approx(0.025, rel=1e-3)
    assert recording.force is not None


def test_an_unknown_name_of_a_position_does_not_make_a_recording_one_of_pressures(tmp_path):
    file = written(
        tmp_path / 'bench.csv', ('t_s', 'pressure_command_bar', 'x[mm]', 'pressure_kPa')
    )
    with pytest.raises(RecordingError, match='no position or force under a name') as refused:
        read_recording(file)
    assert "--column 'x[mm]=position_mm'; or give --kind pressure" in str(refused.value)
    assert read_recording(file, kind='pressure').kind == 'pressure'


def test_the_page_shows_the_sentence(tmp_path):
    file = written(tmp_path / 'bench.csv', ('t [s]', 'p_cmd[bar]', 'pos_mm', 'adc'))
    with pytest.raises(RecordingError) as refused:
        read_recording(file)
    page = ' '.join(text_of(DOCS / 'recordings.md').split())
    assert str(refused.value).replace(", 'adc'", '') in page
