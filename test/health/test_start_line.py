# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The line at the start says which rig it is, with which topics, rates and time."""

import pytest

from pam_ros.health import start_line
from pam_ros.settings.control import settings_of
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked


def resolve(name):
    return f'/arm/{name}'


def simulator(given, *, has_sim_time=False):
    scene = Scene(given)
    values = checked(scene.table(), given)
    setup = scene.build(values)
    return start_line.of_simulator(setup, values, resolve, has_sim_time=has_sim_time)


def controller(given, *, has_sim_time=False):
    table, build = settings_of(given)
    values = checked(table, given)
    return start_line.of_controller(build(values), values, resolve, has_sim_time=has_sim_time)


PAIR = {'joint': 'antagonistic', 'muscles': ('front', 'back'), 'joint_name': 'elbow'}


@pytest.mark.parametrize(
    ('given', 'line'),
    [
        (
            {'muscle': 'dmsp_10', 'mass': 3.0, 'mount': 'horizontal', 'publish_rate': 100.0},
            'simulates the muscle dmsp_10 of 0.25 m with a load of 3 kg horizontal; commands: '
            '/arm/pressure_command; states: /arm/joint_states at 100 Hz; time_mode: real_time',
        ),
        (
            {'time_mode': 'scaled', 'speed_factor': 2.5, 'l0': 0.5},
            'simulates the muscle of 0.5 m with a load of 20 kg vertical; commands: '
            '/arm/pressure_command; states: /arm/joint_states at 500 Hz; time_mode: scaled with '
            'speed_factor 2.5',
        ),
        (
            {
                'muscles': ('left', 'right'),
                'left.muscle': 'dmsp_10',
                'right.mass': 7.0,
                'muscle_topics': True,
                'time_mode': 'lockstep',
            },
            'simulates 2 muscles left, right (dmsp_10 of 0.25 m, of 0.4 m), each with its own '
            'load of 5 kg vertical, 7 kg vertical; commands: /arm/pressure_commands, '
            '/arm/left/pressure_command, /arm/right/pressure_command; states: '
            '/arm/joint_states at 500 Hz; time_mode: lockstep',
        ),
        (
            PAIR | {'plane': 'horizontal'},
            'simulates the joint elbow (antagonistic) with the muscles front, back (of 0.4 m) and '
            'a load of 1 kg on a horizontal arm of 0.25 m; commands: /arm/pressure_commands; '
            'states: /arm/joint_states at 500 Hz; time_mode: real_time',
        ),
        (
            {'muscles': ('a',), 'joint_names': ('knee',), 'joint': 'crank', 'knee.mass': 2.0},
            'simulates the joint knee (crank) with the muscles a (of 0.4 m) and a load of 2 kg on '
            'a vertical arm of 0.25 m; commands: /arm/pressure_commands; states: '
            '/arm/joint_states at 500 Hz; time_mode: real_time',
        ),
    ],
)
def test_of_a_simulator(given, line):
    assert simulator(given) == line


def test_of_a_simulator_that_follows_the_clock():
    assert simulator({}, has_sim_time=True).endswith('time_mode: real_time following /clock')


def test_of_many_muscles_the_first_are_named():
    line = simulator({'muscles': tuple(f'm{i}' for i in range(64))})
    assert 'simulates 64 muscles m0, m1, m2, m3, m4 and others (of 0.4 m)' in line


def test_of_a_controller():
    assert controller({'muscle': 'dmsp_20_400n', 'rate': 250.0}) == (
        'controls the joint pam (load; muscle dmsp_20_400n of 0.4 m; load of 20 kg vertical) '
        'with the law sliding_mode; states: /arm/joint_states; commands: /arm/pressure_command, '
        'at 250 Hz; references: /arm/position_reference, /arm/joint_trajectory'
    )


def test_of_a_controller_of_a_pair_in_simulated_time():
    line = controller(
        PAIR | {'controller': 'pid', 'muscle_topics': True, 'start_enabled': False},
        has_sim_time=True,
    )
    assert 'the joint elbow (antagonistic; muscle of 0.4 m; load of 1 kg on a vertical arm' in line
    assert 'with the law pid' in line
    assert '/arm/front/pressure_command, /arm/back/pressure_command, one for each' in line
    assert '/arm/co_contraction_reference; disabled until' in line
