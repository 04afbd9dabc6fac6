# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is drawn of the messages of a rig."""

from types import SimpleNamespace

import pytest

from pam_ros.plot.topics import MOST_COLUMNS, TOPICS, Key, muscles_of, numbers
from support import bags


def test_numbers_are_in_si_and_pressures_are_gauge():
    assert numbers('force', bags.number(12.5)) == [(Key('force', 'force'), 12.5)]
    ((key, pressure),) = numbers('pressure', bags.fluid(0, 101325.0 + 2e5))
    assert key == Key('pressure', 'pressure')
    assert pressure == pytest.approx(2e5)
    assert numbers('pressure_command', bags.number(3e5))[0][1] == 3e5
    found = numbers('pressures', bags.numbers([101325.0, 201325.0]))
    assert found == [
        (Key('pressure', 'pressures', '0'), 0.0),
        (Key('pressure', 'pressures', '1'), 1e5),
    ]
    assert [value for _, value in numbers('pressure_commands', bags.numbers([1.0, 2.0]))] == [1, 2]


def test_joints_have_their_names_and_efforts_only_if_they_are_filled():
    message = bags.joint(0, [0.1, 0.2], effort=[3.0, 4.0], names=('hip', 'knee'))
    assert dict(numbers('joint_states', message)) == {
        Key('position', 'joint_states', 'hip'): 0.1,
        Key('position', 'joint_states', 'knee'): 0.2,
        Key('effort', 'joint_states', 'hip'): 3.0,
        Key('effort', 'joint_states', 'knee'): 4.0,
    }
    message = bags.joint(0, [0.1], names=('hip',))
    assert numbers('joint_states', message) == [(Key('position', 'joint_states', 'hip'), 0.1)]


def test_the_reference_is_taken_from_the_state_of_the_controller():
    message = bags.joint(0, [1.0, 0.06, 3.0], names=('error', 'reference', 'position'))
    assert numbers('pam_control/state', message) == [(Key('position', 'pam_control/state'), 0.06)]
    assert numbers('pam_control/state', bags.joint(0, [1.0], names=('error',))) == []


def test_an_array_of_any_length_gives_a_bounded_number_of_curves():
    message = bags.numbers([1.0] * 1000, label='')
    assert len(numbers('forces', message)) == MOST_COLUMNS


@pytest.mark.parametrize(
    ('label', 'names'),
    [
        ('flexor,extensor', ('flexor', 'extensor')),
        ('flexor, extensor', ('flexor', 'extensor')),
        ('flexor', ()),
        ('flexor,', ()),
        ('', ()),
    ],
)
def test_muscles_are_named_by_a_label_that_fits(label, names):
    assert muscles_of('forces', bags.numbers([1.0, 2.0], label=label)) == names


def test_messages_without_a_label_name_no_muscle():
    bare = SimpleNamespace(data=[1.0, 2.0], layout=SimpleNamespace(dim=[]))
    assert muscles_of('forces', bare) == ()
    assert muscles_of('force', bags.number(1.0)) == ()


def test_all_topics_that_the_recorder_takes_are_drawn():
    nodes = pytest.importorskip('pam_ros.nodes.record.node')
    assert {*nodes.OF_MUSCLE, *nodes.OF_JOINTS} <= set(TOPICS)
