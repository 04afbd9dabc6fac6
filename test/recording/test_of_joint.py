# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of joints of several muscles, from their signals and from files."""

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.csv_file import write_csv
from pam_ros.recording.mapping import read_mapping
from pam_ros.recording.of_joint import of_joint
from pam_ros.recording.read import read_recording
from pam_ros.recording.series import Series
from support.known import known

T = np.arange(2000) * 0.01
UP = 200.0 + 150.0 * np.sin(0.9 * T) * np.sin(0.17 * T)  # kPa
DOWN = 250.0 - 120.0 * np.sin(1.3 * T)
ANGLE = 0.5 * np.sin(0.9 * T) + 1e-4 * np.random.default_rng(3).normal(size=T.size)
REACH = (-1.5, 1.5)
ELBOW = known(muscles=2, unit='rad', p_max=6e5, reach=REACH)


def write(path, columns):
    header = ','.join(columns)
    np.savetxt(path, np.stack([*columns.values()], axis=1), delimiter=',', header=header,
               comments='', fmt='%.9g')  # fmt: skip
    return path


def elbow(path, **changes):
    columns = {
        't_s': T,
        'flexor.pressure_command_kPa': UP,
        'extensor.pressure_command_kPa': DOWN,
        'position_rad': ANGLE,
    }
    columns = {**columns, **changes}
    return write(path / 'elbow.csv', {k: v for k, v in columns.items() if v is not None})


def test_commands_stand_side_by_side_in_the_order_of_the_joint(tmp_path):
    names = ('extensor', 'flexor')
    one = read_recording(elbow(tmp_path), ELBOW, muscles=names)
    assert (one.muscles, one.unit, one.kind) == (names, 'rad', 'free')
    np.testing.assert_allclose(one.command, 1e3 * np.stack([DOWN, UP], axis=1), rtol=1e-8)
    np.testing.assert_allclose(one.position, ANGLE, atol=1e-8)
    assert one.warnings == ()


def test_without_a_joint_the_order_is_that_of_the_file(tmp_path):
    one = read_recording(elbow(tmp_path))
    assert (one.muscles, one.unit) == (('flexor', 'extensor'), 'rad')


def test_degrees_and_names_of_other_columns(tmp_path):
    file = elbow(tmp_path, position_rad=None, position_deg=np.degrees(ANGLE))
    np.testing.assert_allclose(read_recording(file).position, ANGLE, atol=1e-7)
    file = elbow(
        tmp_path, **{'flexor.pressure_command_kPa': None, 'extensor.pressure_command_kPa': None},
        V1=UP / 100.0, V2=DOWN / 100.0,
    )  # fmt: skip
    rules = ['V1=flexor.pressure_command_bar', 'V2=extensor.pressure_command_kPa*100']
    one = read_recording(file, mapping=read_mapping(rules))
    np.testing.assert_allclose(one.command, 1e3 * np.stack([UP, DOWN], axis=1), rtol=1e-7)


def test_measured_pressures_and_what_is_written_read_back_to_the_same_numbers(tmp_path):
    file = elbow(
        tmp_path, **{'flexor.pressure_kPa': UP + 1.0, 'extensor.pressure_kPa': DOWN - 1.0}
    )
    one = read_recording(file)
    assert one.pressure.shape == one.command.shape == (T.size, 2)
    write_csv(one, tmp_path / 'again.csv')
    header = (tmp_path / 'again.csv').read_text().splitlines()[0]
    assert header == (
        't_s,flexor.pressure_command_Pa,extensor.pressure_command_Pa,position_rad,'
        'flexor.pressure_Pa,extensor.pressure_Pa'
    )
    again = read_recording(tmp_path / 'again.csv')
    for name in ('t', 'command_t', 'command', 'position', 'pressure'):
        np.testing.assert_array_equal(getattr(again, name), getattr(one, name))


def test_commands_that_are_given_where_they_change_hold_until_then():
    up = Series('up', np.array([0.0, 2.0]), np.array([1.0, 3.0]))
    down = Series('down', np.array([1.0, 3.0]), np.array([10.0, 30.0]))
    series, names = of_joint(
        'log', {'a.pressure_command': up, 'b.pressure_command': down}, ('a', 'b'), []
    )
    both = series['pressure_command']
    assert names == ('a', 'b')
    assert both.t.tolist() == [1.0, 2.0, 3.0]
    assert both.value.tolist() == [[1.0, 10.0], [3.0, 10.0], [3.0, 30.0]]


def test_part_of_a_recording_keeps_its_muscles(tmp_path):
    part = read_recording(elbow(tmp_path)).part(100, 300)
    assert part.muscles == ('flexor', 'extensor')
    assert part.command.shape == (200, 2)
    stamps, values = part.drive(1e-3)
    assert values.shape == (stamps.size, 2)


def test_a_pressure_that_not_all_muscles_have_is_noted(tmp_path):
    one = read_recording(elbow(tmp_path, **{'flexor.pressure_kPa': UP + 1.0}))
    assert one.pressure is None
    assert 'flexor.pressure_kPa is not used: not all muscles have one' in one.warnings


def test_forces_of_single_muscles_are_noted(tmp_path):
    one = read_recording(elbow(tmp_path, **{'flexor.force_N': UP}))
    assert one.force is None
    assert 'flexor.force_N: forces of the muscles of a joint are not used' in one.warnings


@pytest.mark.parametrize(
    ('changes', 'words'),
    [
        (
            {'extensor.pressure_command_kPa': None},
            'elbow.csv has flexor.pressure_command_kPa but no extensor.pressure_command: a column '
            'is needed for each of flexor, extensor',
        ),
        (
            {'extensor.pressure_command_kPa': None, 'wrist.pressure_command_kPa': DOWN},
            "elbow.csv: wrist.pressure_command_kPa is of a muscle 'wrist', which the joint does "
            'not have: its muscles are flexor, extensor;',
        ),
        (
            {'pressure_command_kPa': UP},
            'elbow.csv: pressure_command_kPa does not name a muscle, and the joint has 2: name it '
            'flexor.pressure_command_kPa, or likewise with another of flexor, extensor',
        ),
        (
            {'position_rad': None, 'position_mm': ANGLE},
            'elbow.csv: the position is in m, and the model moves in rad: is it a recording of '
            'another joint?',
        ),
        (
            {'position_mm': ANGLE},
            'elbow.csv: position_rad is an angle and position_mm a length: one of them is of',
        ),
        (
            {'position_rad': np.degrees(ANGLE)},
            'elbow.csv: position reaches 28.6568 rad, which cannot be right (at most 6.28319 rad)',
        ),
        (
            {'position_rad': 4.0 * ANGLE},
            'elbow.csv: position = 1.50845 rad at 0.95 s is outside -1.5 to 1.5 rad, where the '
            'muscles of this joint have a length: is it in another unit (position_deg)',
        ),
        (
            {
                'flexor.pressure_command_kPa': 0.0 * T + 200.0,
                'extensor.pressure_command_kPa': 0.0 * T + 250.0,
            },
            'elbow.csv: flexor.pressure_command and extensor.pressure_command are constant at '
            '200000 Pa and 250000 Pa, so that no parameter can be identified',
        ),
        (
            {
                'flexor.pressure_command_kPa': 1e-4 * UP,
                'extensor.pressure_command_kPa': 1e-4 * DOWN,
            },
            'elbow.csv: flexor.pressure_command stays below',
        ),
    ],
)
def test_what_is_refused(tmp_path, changes, words):
    file = elbow(tmp_path, **changes)
    with pytest.raises(RecordingError) as error:
        read_recording(file, ELBOW, muscles=('flexor', 'extensor'))
    assert str(error.value).startswith(words)


def test_a_constant_command_of_one_muscle_is_warned_of(tmp_path):
    one = read_recording(elbow(tmp_path, **{'extensor.pressure_command_kPa': 0.0 * T + 250.0}))
    assert (
        'extensor.pressure_command is constant at 250000 Pa: its influence cannot be seen'
        in one.warnings
    )


def test_columns_of_one_named_muscle_are_those_of_a_model_with_one(tmp_path):
    columns = {'t_s': T, 'thigh.pressure_command_kPa': UP, 'position_mm': 20.0 * ANGLE + 20.0}
    one = read_recording(write(tmp_path / 'one.csv', columns), known(l0=0.4, p_max=6e5))
    assert one.muscles == ()
    np.testing.assert_allclose(one.command, 1e3 * UP, rtol=1e-8)


def test_a_recording_of_two_muscles_for_a_model_with_one(tmp_path):
    file = elbow(tmp_path, position_rad=None, position_mm=20.0 * ANGLE)
    with pytest.raises(RecordingError, match='signals of flexor, extensor, and the model one'):
        read_recording(file, muscles=('muscle',))


def test_the_measured_elbow(shared_data):
    files = sorted((shared_data / 'laas_elbow').glob('*.csv'))
    assert len(files) == 13
    for file in files:
        one = read_recording(
            file, known(muscles=2, unit='rad', p_max=5e5), muscles=('agonist', 'antagonist')
        )
        columns = np.genfromtxt(file, delimiter=',', skip_header=1)
        np.testing.assert_allclose(one.command, 1e3 * columns[:, 1:3])
        np.testing.assert_allclose(one.position, columns[:, 3])
