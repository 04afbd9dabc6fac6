# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags of joints of several muscles: arrays of commands and pressures, an angle."""

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.mapping import read_mapping
from pam_ros.recording.read import read_recording
from support import bags
from support.known import known

T = np.arange(400) * 0.01
UP, DOWN = 3e5 + 1e5 * np.sin(3.0 * T), 2.5e5 - 8e4 * np.sin(2.0 * T)
ANGLE = 0.4 * np.sin(3.0 * T)
NAMES = ('flexor', 'extensor')
AIR = 101325.0


def topics(space='', **changes):
    stamps = [bags.ns(t) for t in T]
    both = list(zip(stamps, UP, DOWN, strict=True))
    found = {
        'pressure_commands': (bags.ARRAY, [(at, bags.numbers((a, b))) for at, a, b in both]),
        'joint_states': (
            bags.JOINT,
            [
                (at, bags.joint(at, [y], [0.1 * y], [1.0]))
                for at, y in zip(stamps, ANGLE, strict=True)
            ],
        ),
        'pressures': (
            bags.ARRAY,
            [(at, bags.numbers((a + AIR - 1e3, b + AIR - 2e3))) for at, a, b in both],
        ),
    }
    found = {**found, **changes}
    return {f'{space}/{name}': one for name, one in found.items() if one is not None}


def read(path, given, names=NAMES, unit='rad', rules=(), **more):
    bag = bags.write_bag(path / 'bag', given)
    return read_recording(
        bag, known(unit=unit), mapping=read_mapping(rules), muscles=names, **more
    )


def test_arrays_become_columns_of_the_muscles(tmp_path):
    one = read(tmp_path, topics())
    assert (one.muscles, one.unit, one.kind) == (NAMES, 'rad', 'free')
    np.testing.assert_allclose(one.command, np.stack([UP, DOWN], axis=1))
    np.testing.assert_allclose(one.pressure, np.stack([UP - 1e3, DOWN - 2e3], axis=1))
    np.testing.assert_allclose(one.position, ANGLE)
    np.testing.assert_allclose(one.velocity, 0.1 * ANGLE)
    assert one.force is None  # the effort is a torque
    assert one.command_spread > 0.0


def test_messages_that_are_decoded_singly_give_the_same(tmp_path):
    given = topics()
    kind, messages = given['/pressures']
    # Labels of other lengths: the messages are no longer alike.
    mixed = [
        (at, bags.numbers(one.data, 'flexor,extensor' if k % 2 else 'a'))
        for k, (at, one) in enumerate(messages)
    ]
    one = read(tmp_path, {**given, '/pressures': (kind, mixed)})
    np.testing.assert_allclose(one.pressure, np.stack([UP - 1e3, DOWN - 2e3], axis=1))


def test_a_joint_in_a_namespace_and_a_load_that_slides(tmp_path):
    one = read(tmp_path, {**topics('/left'), **topics('/right')}, unit='m', namespace='left')
    assert one.unit == 'm'
    np.testing.assert_allclose(one.position, ANGLE)


def test_a_namespace_that_is_not_there(tmp_path):
    with pytest.raises(RecordingError, match=r'^bag has no /left/joint_states: it has /right/'):
        read(tmp_path, topics('/right'), namespace='left')


def test_one_muscle_of_a_crank_has_arrays_of_one(tmp_path):
    stamps = [bags.ns(t) for t in T]
    commands = [(at, bags.numbers((u,), 'pam')) for at, u in zip(stamps, UP, strict=True)]
    given = topics(pressure_commands=(bags.ARRAY, commands), pressures=None)
    one = read(tmp_path, given, names=('pam',))
    assert (one.muscles, one.unit) == ((), 'rad')
    np.testing.assert_allclose(one.command, UP)


@pytest.mark.parametrize(
    ('changes', 'names', 'words'),
    [
        ({}, ('a', 'b', 'c'), 'bag: /pressure_commands.data[2] is not there: the message has 2'),
        (
            {'pressure_commands': None, 'pressures': None},
            NAMES,
            'bag has neither pressure_command nor pressure: one of them is needed as the input',
        ),
        (
            {'pressure_commands': (bags.FLOAT, [(bags.ns(0.0), bags.number(3e5))])},
            NAMES,
            'bag: /pressure_commands is a std_msgs/msg/Float64, not a std_msgs/msg/Float64Multi',
        ),
    ],
)
def test_what_is_refused(tmp_path, changes, names, words):
    with pytest.raises(RecordingError) as error:
        read(tmp_path, topics(**changes), names=names)
    assert str(error.value).startswith(words)
