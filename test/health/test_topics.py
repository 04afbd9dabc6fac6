# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is said of the publishers and subscribers of a topic."""

import struct

import pytest

from pam_ros.health.health import Level
from pam_ros.health.topics import LASTING, Senders, TopicHealth, names_one_of, topics

TWO = ['/left/pam_sim', '/right/pam_sim']


def finds(*seconds):
    """Return whether several senders are found after the numbers of each second."""
    senders, found = Senders(), []
    for numbers in seconds:
        for number in numbers:
            senders.take(number)
        found.append(senders.are_several())
    return found


def test_numbers_that_only_rise_are_of_one_publisher():
    assert finds([1, 2, 5], [6], [], [100, 101]) == [False] * 4
    assert finds([None, None], [None]) == [False, False]


@pytest.mark.parametrize(
    'seconds',
    [
        ([7, 3, 8, 4], [9, 5, 10, 6]),
        ([7, 7, 8, 8], [9, 9, 10, 10]),
        ([1, 500, 501, 502], [2, 700, 701], [900, 901, 3]),
        ([10, 11, 900, 12], [13, 14, 901], [15, 16]),
    ],
    ids=['alike', 'the_same_numbers', 'slow_one', 'slow_one_with_higher_numbers'],
)
def test_numbers_that_go_back_again_and_again_are_of_several(seconds):
    assert finds(*seconds)[1:] == [True] * (len(seconds) - 1)


def test_a_publisher_that_is_started_again_is_found_for_less_than_what_lasts():
    found = finds([500, 501], [502, 1, 2], [3, 4], [5], [6])
    assert found == [False, True, True, False, False]
    assert found.count(True) < LASTING


def look(health, count, publishers=('/pam_sim',), *, is_alone=False, has_several=False):
    return [health.look(publishers, is_alone, has_several) for _ in range(count)]


def test_commands_without_a_subscriber_are_reported_once_if_that_lasts():
    health = TopicHealth('/left/pressure_command')
    *before, begins = look(health, LASTING, is_alone=True)
    assert before == [[]] * (LASTING - 1)
    assert begins == [health.unreceived]
    assert health.unreceived.startswith('commands on /left/pressure_command have no subscriber')
    assert look(health, 5, is_alone=True) == [[]] * 5
    found = topics([health], [1])
    assert (found.level, found.message) == (Level.WARN, health.unreceived)
    look(health, 1)
    assert topics([health], [1]).level == Level.OK


def test_several_senders_are_reported_with_topic_count_and_nodes():
    health = TopicHealth('/pressure')
    assert not any(look(health, LASTING - 1, TWO, has_several=True))
    assert look(health, 2, [*TWO, ''], has_several=True) == [[health.contested], []]
    assert health.contested == (
        '/pressure has 3 publishers (/left/pam_sim, /right/pam_sim), and more than one of them '
        'sends: stop all but one'
    )
    found = topics([health], [3])
    assert found.level == Level.WARN
    assert found.values == {'publishers of /pressure': 3}


def test_the_warning_does_not_flicker_and_ends():
    health = TopicHealth('/pressure')
    look(health, LASTING, TWO, has_several=True)
    look(health, LASTING - 1)
    assert health.contested
    look(health, 1)
    assert not health.contested


def test_several_senders_of_joint_states_are_reported_with_the_joint():
    health = TopicHealth('/joint_states', ('elbow',))
    look(health, LASTING, TWO, has_several=True)
    assert 'more than one of them sends the joint elbow: stop all but one' in health.contested
    health = TopicHealth('/joint_states', tuple('abcdefg'))
    look(health, LASTING, ['', ''], has_several=True)
    assert 'has 2 publishers, and' in health.contested
    assert 'sends the joints a, b, c, d, e and others' in health.contested


def joint_state(order, frame, *names):
    """Return the beginning of a serialized JointState, up to its names."""
    data = bytes([0, order == '<', 0, 0]) + bytes(8)
    for text in (frame, None, *names):
        data += bytes(-len(data) % 4)
        if text is None:
            data += struct.pack(f'{order}I', len(names))
        else:
            data += struct.pack(f'{order}I', len(text) + 1) + text.encode() + b'\0'
    return data


@pytest.mark.parametrize('order', ['<', '>'])
def test_the_joint_of_a_serialized_message_is_found_by_its_whole_name(order):
    message = joint_state(order, 'pam', 'left_pam', 'pam_2', 'elbow')
    assert names_one_of(['elbow'], message)
    assert names_one_of(['pam', 'pam_2'], message)
    assert not names_one_of(['pam'], message)
    assert not names_one_of(['pam'], message[:10])
