# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings in which time goes back are drawn in parts, one after another."""

import numpy as np
import pytest

from pam_ros.plot.recorded import read
from pam_ros.plot.restarts import TopicTimes, one_after_another
from pam_ros.plot.topics import Key
from pam_ros.recording.mapping import ColumnMapping
from support import bags

POSITION, COMMAND = Key('position', 'joint_states', 'pam'), Key('pressure', 'pressure_command')


def ns(seconds):
    return np.round(np.array(seconds) * 1e9).astype(np.int64)


def seconds(times):
    return {topic: (own * 1e-9).tolist() for topic, own in times.items()}


def test_time_that_only_ascends_is_as_it_is():
    t = ns([1.0, 2.0, 1.8, 3.0])  # a message is late
    times, note = one_after_another({'a': TopicTimes(ns([5.0, 6.0, 7.0, 8.0]), t)})
    assert note == ''
    assert np.array_equal(times['a'], t)


def test_all_topics_are_divided_at_the_same_moment():
    times, note = one_after_another(
        {
            'often': TopicTimes(ns([0, 1, 2, 3, 4, 5]), ns([10, 11, 12, 1, 2, 3])),
            # It shows the jump itself, and its last message of the first part is late.
            'late': TopicTimes(ns([0.5, 3.1, 4.1]), ns([10.5, 12.5, 2.0])),
            # Its time goes forward, although it is that of the next part.
            'seldom': TopicTimes(ns([4.5]), ns([2.5])),
            'none after': TopicTimes(ns([1.0]), ns([11.0])),
        }
    )
    assert seconds(times) == {
        'often': pytest.approx([10.0, 11.0, 12.0, 13.5, 14.5, 15.5]),
        'late': pytest.approx([10.5, 12.5, 14.5]),
        'seldom': pytest.approx([15.0]),
        'none after': pytest.approx([11.0]),
    }
    assert note.startswith('time goes back by 11.5 s at 2.5 s (a simulation that started again')


def test_each_jump_begins_a_part():
    received = ns(np.arange(9.0))
    times, note = one_after_another(
        {'a': TopicTimes(received, ns([5, 6, 7, 1, 2, 3, 0, 1, 2]))},
    )
    assert seconds(times)['a'] == pytest.approx([5, 6, 7, 8, 9, 10, 11, 12, 13])
    assert ', the first of 2 times ' in note


def test_a_simulation_that_started_again_is_drawn_behind_itself(tmp_path):
    """Commands have no header: their time follows from that of the states."""
    states, commands = [], []
    for run in range(2):
        for k in range(300):
            at, stamp = bags.ns(4.0 * run + 0.001 * k), 10**9 + 10**7 * k
            states.append((at, bags.joint(stamp, [0.01 * (run + 1)])))
            if k % 50 == 25:
                commands.append((at + 500_000, bags.number(1e5 * (run + 1))))
    topics = {
        '/joint_states': (bags.JOINT, states),
        '/pressure_command': (bags.FLOAT, commands),
    }
    found = read(bags.write_bag(tmp_path / 'bag', topics), None, ColumnMapping())
    t, position = found.curves.samples[POSITION]
    grid = 0.01 * np.arange(300)
    assert t == pytest.approx(np.concatenate([grid, grid + 3.99]))
    assert position == pytest.approx(np.repeat([0.01, 0.02], 300))
    t, command = found.curves.samples[COMMAND]
    expected = 0.255 + 0.5 * np.arange(6)
    assert t == pytest.approx(np.concatenate([expected, expected + 3.99]))
    assert command == pytest.approx(np.repeat([1e5, 2e5], 6))
    assert found.end == pytest.approx(3.99 + 2.99)
    assert any('goes back by 2.99 s at 2.99 s' in note for note in found.notes)
