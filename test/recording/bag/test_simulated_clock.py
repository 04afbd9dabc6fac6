# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags of a rig in simulated time that were recorded in real time."""

import numpy as np
import pytest

from pam_ros.recording.bag.read import read_bag
from pam_ros.recording.mapping import ColumnMapping
from support import bags

FIRST = 10**9  # ns, where simulated time begins
CLOCK = 'rosgraph_msgs/msg/Clock'


def wall(t):
    """Return the time in s on the wall at *t* s: the simulation waits, and then is fast."""
    return 3.0 + t / 7.0


def clock(t):
    time = bags.TYPES['builtin_interfaces/msg/Time']
    stamp = FIRST + round(t * 1e9)
    return bags.TYPES[CLOCK](time(stamp // 10**9, stamp % 10**9))


def lockstep(stamped=lambda since: FIRST + since, rate=200, at=wall):
    """Return a rig's topics as a recorder without simulated time stores them, and the truth.

    *stamped* is the stamp of a header and *at* the wall time of a simulated time; ``/clock`` has
    this *rate* in Hz of simulated time, and is left out if it is None.
    """
    topics, truth = bags.rig_topics(late=0.0)
    for topic, (kind, messages) in topics.items():
        moved = []
        for stamp, message in messages:
            since = stamp - bags.EPOCH
            if hasattr(message, 'header'):
                message.header = bags.header(stamped(since))
            moved.append((bags.ns(at(since * 1e-9)), message))
        topics[topic] = (kind, moved)
    if rate is not None:
        ticks = np.arange(round(4 * rate) + 1) / rate
        topics['/clock'] = (CLOCK, [(bags.ns(at(t)), clock(t)) for t in ticks])
    return topics, truth


def read(path, topics, time='header'):
    return read_bag(bags.write_bag(path / 'bag', topics), ColumnMapping(), time=time)


@pytest.mark.parametrize(
    ('rate', 'what'), [(200, 'with /clock'), (None, 'with the headers of /joint_states')]
)
def test_all_messages_are_on_the_axis_of_the_headers(tmp_path, rate, what):
    topics, truth = lockstep(rate=rate)
    series, (note,) = read(tmp_path, topics)
    assert note.endswith(f'converted to simulated time {what}')
    for key, name in (
        ('position', 'position'),
        ('pressure', 'pressure'),
        ('force', 'force'),
        ('pressure_command', 'command'),
    ):
        t, value = truth[name]
        np.testing.assert_allclose(series[key].value, value)
        np.testing.assert_allclose(series[key].t, t, atol=1e-6 if rate else 1e-3)


def test_stamps_of_zero_leave_all_to_the_clock(tmp_path):
    topics, truth = lockstep(stamped=lambda since: 0)
    series, notes = read(tmp_path, topics)
    assert any('with /clock' in note for note in notes)
    t, _ = truth['command']
    np.testing.assert_allclose(series['pressure_command'].t, t, atol=1e-6)
    t, _ = truth['position']
    np.testing.assert_allclose(series['position'].t, t, atol=1e-6)


def test_a_node_on_another_clock_has_times_of_receipt_on_the_same_axis(tmp_path):
    topics, truth = lockstep()
    _, messages = topics['/pressure']
    for stamp, message in messages:
        message.header = bags.header(stamp)  # on the wall
    series, notes = read(tmp_path, topics)
    assert any(note.startswith('/pressure was stamped by a clock') for note in notes)
    for key, name in (('position', 'position'), ('pressure', 'pressure')):
        np.testing.assert_allclose(series[key].t, truth[name][0], atol=1e-6)


def test_real_stamps_next_to_a_clock_of_others_are_kept(tmp_path):
    topics, _ = bags.rig_topics(late=0.01)
    topics['/clock'] = (CLOCK, [(bags.ns(t), clock(t)) for t in np.arange(0.0, 4.0, 0.1)])
    series, notes = read(tmp_path, topics)
    assert notes == []
    np.testing.assert_allclose(np.diff(series['position'].t), 5e-3, atol=1e-9)


def test_a_clock_that_is_only_set_differently_needs_no_conversion(tmp_path):
    topics, _ = lockstep(rate=None, at=lambda t: t)
    _, (note,) = read(tmp_path, topics)
    assert note.endswith('all messages get the time of their receipt')


def test_times_of_receipt_are_given_if_they_are_wanted(tmp_path):
    topics, truth = lockstep()
    series, notes = read(tmp_path, topics, time='received')
    assert notes == []
    t, _ = truth['position']
    np.testing.assert_allclose(series['position'].t - series['position'].t[0], t / 7.0, atol=1e-6)
