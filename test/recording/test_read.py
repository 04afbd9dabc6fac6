# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings read whole: measured data, bags, and files that cannot be used."""

import hashlib
import os
import re

import numpy as np
import pytest

from pam_ros.errors import ParameterError, RecordingError
from pam_ros.recording.csv_file import write_csv
from pam_ros.recording.mapping import read_mapping
from pam_ros.recording.read import read_recording
from pam_ros.recording.recording import Recording
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
from support import bags
from support.known import known


def table(path):
    """Return a CSV's columns by an independent reader."""
    return np.genfromtxt(path, delimiter=',', names=True)


@pytest.mark.parametrize('name', ['kappa00.00_test01', 'kappa09.05_test02', 'kappa17.59_test05'])
def test_the_measured_muscle(shared_data, name):
    file = shared_data / 'psu_dmsp20_398mm' / f'{name}.csv'
    one = read_recording(file, known(l0=0.398, p_max=6e5))
    columns = table(file)
    assert one.kind == 'held'
    assert one.command is None
    assert one.gaps == ()
    np.testing.assert_allclose(one.t, columns['t_s'] - columns['t_s'][0], atol=1e-9)
    np.testing.assert_allclose(one.pressure, 1e3 * columns['pressure_kPa'])
    np.testing.assert_allclose(one.position, 0.00398 * float(name[5:10]), atol=1e-12)
    np.testing.assert_allclose(one.force, columns['force_N'])
    assert 'columns not used: state_1fill_2vent' in one.warnings
    assert one.digest == hashlib.sha256(file.read_bytes()).hexdigest()


def test_a_cell_at_its_limit_is_warned_of(shared_data):
    folder = shared_data / 'psu_dmsp20_398mm'
    clipped = read_recording(folder / 'kappa17.59_test05.csv', known(l0=0.398))
    assert any('force stays at its lowest value, -18.59 N' in text for text in clipped.warnings)
    free = read_recording(folder / 'kappa00.00_test03.csv', known(l0=0.398))
    assert not any('force rests' in text for text in free.warnings)


def test_every_run_of_the_measured_muscle_can_be_read(shared_data):
    files = sorted((shared_data / 'psu_dmsp20_398mm').glob('*.csv'))
    assert len(files) == 20
    for file in files:
        one = read_recording(file, known(l0=0.398, p_max=6e5))
        assert one.kind == 'held'
        assert len(one.segments()) == 1


def test_the_measured_drive(shared_data):
    file = shared_data / 'emps' / 'emps_estimation.csv'
    one = read_recording(
        file, known(p_max=10.0), mapping=read_mapping(['motor_voltage_V=pressure_command_Pa'])
    )
    columns = table(file)
    assert one.kind == 'free'
    assert one.t.size == 24_841
    np.testing.assert_allclose(one.t, columns['t_s'])
    np.testing.assert_allclose(one.command_t, columns['t_s'])
    np.testing.assert_allclose(one.command, columns['motor_voltage_V'])
    np.testing.assert_allclose(one.position, columns['position_m'])
    assert one.warnings == ('columns not used: reference_m',)


@pytest.mark.parametrize(
    ('name', 'words'),
    [
        ('festo_dmsp20_datasheet_points.csv', ['no time axis', 'pressure_kPa']),
        ('petre2021_noload_hysteresis.csv', ['no time axis']),
        ('martens_dmsp20_300_measured.csv', ['no time axis']),
        ('emps/emps_estimation.csv', ['neither pressure_command nor pressure']),
    ],
)
def test_data_that_are_no_recordings(shared_data, name, words):
    with pytest.raises(RecordingError) as caught:
        read_recording(shared_data / name)
    for word in words:
        assert word in str(caught.value)


def test_a_bag(tmp_path):
    topics, truth = bags.rig_topics(duration=12.0)
    bag = bags.write_bag(tmp_path / 'bag', topics)
    one = read_recording(bag, known(l0=0.4, p_max=6e5))
    t, y = truth['position']
    keep = t >= 0.5
    assert one.name == 'bag'
    assert one.kind == 'free'
    np.testing.assert_allclose(one.t, t[keep] - 0.5, atol=1e-9)
    np.testing.assert_allclose(one.position, y[keep])
    np.testing.assert_allclose(one.command_t, truth['command'][0] - 0.5, atol=1e-9)
    np.testing.assert_allclose(one.command, truth['command'][1])
    # Sampled at other times: as good as straight lines are.
    np.testing.assert_allclose(one.force, 196 + 10 * np.cos(2 * np.pi * t[keep]), atol=1e-3)
    assert one.warnings[0] == 'the first 0.5 s have no command yet and are left out'
    assert one.digest == hashlib.sha256((bag / 'bag.mcap').read_bytes()).hexdigest()


def test_a_bag_as_csv_is_the_same_recording(tmp_path):
    topics, _ = bags.rig_topics(duration=12.0)
    one = read_recording(bags.write_bag(tmp_path / 'bag', topics))
    write_csv(one, tmp_path / 'bag.csv')
    other = read_recording(tmp_path / 'bag.csv')
    assert other.kind == one.kind
    for name in ('t', 'command_t', 'command', 'position', 'velocity', 'force', 'pressure'):
        np.testing.assert_array_equal(getattr(other, name), getattr(one, name))


def test_a_csv_file_has_no_namespace(tmp_path):
    (tmp_path / 'rig.csv').write_text('t_s,pressure_command_Pa,position_m\n')
    with pytest.raises(RecordingError, match=r'namespace = left, but recording .*rig\.csv is not'):
        read_recording(tmp_path / 'rig.csv', namespace='left')


def test_a_recording_that_is_not_there(tmp_path):
    with pytest.raises(RecordingError, match=r'recording .*none\.csv does not exist'):
        read_recording(tmp_path / 'none.csv')


@pytest.mark.parametrize(
    ('row', 'words'),
    [
        ('{t},{u},40.0{k}', ['position reaches 40.', 'another unit']),
        ('{t},500,{y}', ['pressure_command is constant']),
        ('{t},0.0003,{y}', ['constant']),
        ('{t},{u}e4,{y}', ['pressure_command reaches']),
    ],
)
def test_values_that_cannot_be_right(tmp_path, row, words):
    rows = [
        row.format(t=k / 100, u=100 + k % 300, y=0.001 * (k % 50), k=k % 7) for k in range(2000)
    ]
    file = tmp_path / 'log.csv'
    file.write_text('\n'.join(['t_s,pressure_command_kPa,position_m', *rows]))
    with pytest.raises(RecordingError) as caught:
        read_recording(file)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ('time', 'words'),
    [
        # Days since 1900, as a spreadsheet stores dates.
        ('{days:.10f}', r't_days: Excel counts days, and has 45292 for a day of our time'),
        ('{minutes:.10f}', 't_min, t_h, t_days'),
        ('{milliseconds:.1f}', 't_ms, t_us, t_ns'),
    ],
)
def test_a_likely_unit_of_the_time_is_named(tmp_path, time, words):
    file = tmp_path / 'log.csv'
    rows = ['t,pressure_command_kPa,position_m']
    for k in range(2000):
        t = k / 1000
        stamp = time.format(days=45292 + t / 86400, minutes=t / 60, milliseconds=1000 * t)
        rows.append(f'{stamp},{100 + k % 300},{0.001 * (k % 50):.3f}')
    file.write_text('\n'.join([*rows, '']))
    with pytest.raises(RecordingError, match=re.escape(f'is the time in another unit ({words})?')):
        read_recording(file)


def test_days_of_a_spreadsheet_are_read(tmp_path):
    rows = [
        f'{45292 + k / 8640000:.10f},{100 + k % 300},{0.001 * (k % 50):.3f}' for k in range(2000)
    ]
    (tmp_path / 'log.csv').write_text('\n'.join(['t_days,pressure_command_kPa,position_m', *rows]))
    found = read_recording(tmp_path / 'log.csv')
    np.testing.assert_allclose(found.t, 0.01 * np.arange(1999), atol=1e-5)


def test_names_of_columns_are_harmless_in_warnings(tmp_path):
    rows = [f'{k / 100},{k % 90},{k % 70},0' for k in range(400)]
    header = 't_s,pressure_command_kPa,position_mm,\x1b[31m' + 'x' * 10**5
    (tmp_path / 'red.csv').write_text('\n'.join([header, *rows, '']))
    (warning,) = (one for one in read_recording(tmp_path / 'red.csv').warnings if 'column' in one)
    assert warning.startswith(r'columns not used: \x1b[31mxxx')
    assert len(warning) < 300


def test_a_pipe_is_refused_without_waiting(tmp_path):
    os.mkfifo(tmp_path / 'pipe.csv')
    with pytest.raises(RecordingError, match=r'pipe\.csv is neither a file nor a folder'):
        read_recording(tmp_path / 'pipe.csv')


def test_a_recording_of_another_joint_is_refused(tmp_path):
    t = np.arange(2000) * 0.01
    one = Recording('one', t, t, 3e5 + 1e5 * np.sin(t), 0.01 * np.sin(t))
    write_csv(one, tmp_path / 'one.csv')
    turning, lifting = antagonistic_joint(), single_muscle_joint()
    with pytest.raises(RecordingError, match='position is in m, and the model moves in rad'):
        read_recording(tmp_path / 'one.csv', turning)
    two = known(muscles=2, p_max=6e5, unit='m')
    with pytest.raises(RecordingError, match=r'of 1 muscle\(s\), and the joint has 2'):
        read_recording(tmp_path / 'one.csv', two)
    with pytest.raises(ParameterError, match=r'joint = .* is not allowed: give a Joint'):
        read_recording(tmp_path / 'one.csv', 'dmsp_20_400n')
    assert read_recording(tmp_path / 'one.csv', lifting).position is not None
