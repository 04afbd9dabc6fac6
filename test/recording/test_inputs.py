# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What drives a recording, muscle by muscle."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.errors import ParameterError, RecordingError
from pam_ros.recording.inputs import driving, is_constant, outputs, quantity_of, refuse_copies
from pam_ros.recording.recording import Recording

T = np.arange(500) * 0.005
NOTHING = {'velocity': None, 'force': None, 'pressure': None, 'kind': 'free'}


def of_one(command_t, command):
    return Recording('one', T, command_t, command, 0.01 * np.sin(T), **NOTHING)


def of_two(**changes):
    command = np.array([[1.0, 10.0], [2.0, 20.0]])
    given = {'command_t': [0.0, 1.0], 'command': command, **NOTHING, **changes}
    return Recording('two', T, position=np.sin(T), muscles=('up', 'down'), unit='rad', **given)


def test_the_input_over_the_samples_is_the_command_that_holds():
    (one,) = driving(of_one(np.array([0.0, 1.0025, 2.0]), np.array([1.0, 2.0, 3.0])), 6e5)
    assert (one.name, one.quantity, one.p_max) == ('pressure_command', 'pressure_command', 6e5)
    assert one.values[[0, 200, 201, 399, 400]].tolist() == [1.0, 1.0, 2.0, 2.0, 3.0]


def test_each_muscle_has_an_input_and_its_highest_pressure():
    up, down = driving(of_two(), [4e5, 6e5])
    assert (up.name, up.quantity, up.p_max) == ('up.pressure_command', 'pressure_command', 4e5)
    assert (down.name, down.p_max) == ('down.pressure_command', 6e5)
    assert down.values[[0, 199, 200]].tolist() == [10.0, 10.0, 20.0]


def test_without_commands_the_measured_pressures_drive():
    pressure = np.stack([np.sin(T), np.cos(T)], axis=1)
    measured = of_two(command=None, command_t=None, pressure=pressure)
    up, down = driving(measured)
    assert (up.name, up.p_max) == ('up.pressure', None)
    np.testing.assert_array_equal(down.values, np.cos(T))
    names = [(name, si) for name, _, si in outputs(measured)]
    assert names == [('position', 'rad'), ('up.pressure', 'Pa'), ('down.pressure', 'Pa')]


def test_a_recording_that_nothing_drives():
    with pytest.raises(RecordingError, match='two: neither pressure_command nor pressure'):
        driving(of_two(command=None, command_t=None))
    with pytest.raises(ParameterError, match='p_max has the shape'):
        driving(of_two(), [4e5, 5e5, 6e5])


def test_the_position_of_a_joint_that_turns_is_an_angle():
    assert quantity_of(of_two(), 'position').si == 'rad'
    assert quantity_of(of_two(), 'pressure').si == 'Pa'
    assert quantity_of(of_one([0.0], [1.0]), 'position').si == 'm'


def test_no_recording_is_given_twice():
    one = of_one(np.array([0.0, 1.0]), np.array([1.0, 2.0]))
    other = of_one(np.array([0.0, 1.0]), np.array([1.0, 3.0]))
    longer = replace(one, t=np.append(T, 2.5), position=np.append(one.position, 0.0))
    refuse_copies([one, other, longer, of_two()])
    copy = replace(one, name='copy')
    with pytest.raises(RecordingError, match=r'^copy has the same samples as one: give each rec'):
        refuse_copies([one, other, copy])
    with pytest.raises(RecordingError, match='two has the same samples as two'):
        refuse_copies([of_two(), of_two()])


@pytest.mark.parametrize('size', [1e-5, 100.0])
def test_a_signal_with_white_noise_is_constant_and_a_slow_one_is_not(size):
    noise = np.random.default_rng(4).standard_normal(T.size)
    level = 3e3 * size
    assert is_constant(level + size * noise)
    assert not is_constant(level + 10.0 * size * np.sin(T) + size * noise)
    assert is_constant(np.full(T.size, level))
