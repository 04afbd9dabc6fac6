# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The clocks of a bag: before /clock, before a clock is set, and stamps that are too coarse."""

import numpy as np
import pytest

from pam_ros.errors import ParameterError, RecordingError
from pam_ros.recording.bag.read import read_bag
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.read import read_recording
from support import bags

LATE = 2e-4
START = 12 * 10**9  # ns, the first time of the simulated clock
BEGIN = 9 * 10**8  # ns after the start, when a clock gets its first time


def rig(received, stamped=lambda stamp: stamp):
    """Return a rig's topics with other times of receipt, and other stamps in their headers.

    Both are functions of the time in ns since the start. The rig has commands from 0 s on.
    """
    topics, truth = bags.rig_topics(late=LATE)
    kind, messages = topics['/pressure_command']
    topics['/pressure_command'] = (kind, [(bags.ns(0.0), bags.number(1e5)), *messages])
    for topic, (kind, messages) in topics.items():
        moved = []
        for stamp, message in messages:
            if hasattr(message, 'header'):
                now = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
                message.header = bags.header(stamped(now - bags.EPOCH))
            moved.append((received(stamp - bags.EPOCH), message))
        topics[topic] = (kind, sorted(moved, key=lambda one: one[0]))
    return topics, truth


def read(path, topics, time='header'):
    return read_bag(bags.write_bag(path / 'bag', topics), ColumnMapping(), time=time)


def after(first, unset):
    """Return a clock that shows *unset* for 0.9 s, and then begins at *first*, both in ns."""
    return lambda since: unset if since < BEGIN else first + since - BEGIN


@pytest.mark.parametrize(
    ('clock', 'unset'),
    [
        (after(START, 0), 0),  # simulated time, before the first /clock
        (after(START, START), START),  # it stands still at first
        (after(bags.EPOCH, 0), 0),
        (after(bags.EPOCH, 40 * 10**9), 40 * 10**9),  # 1970, before the clock is set
    ],
)
def test_messages_from_before_the_clock_are_left_out(tmp_path, clock, unset):
    topics, truth = rig(clock, lambda since: 0)
    series, notes = read(tmp_path, topics)
    # Forces, which have the rate of 250 Hz, are received without a delay.
    t, value = truth['force']
    later = t >= 1e-9 * BEGIN
    kept = series['force']
    np.testing.assert_allclose(kept.value[-later.sum() :], value[later])
    assert later.sum() <= kept.t.size <= later.sum() + 1
    np.testing.assert_allclose(np.diff(kept.t[-later.sum() :]), 1 / 250, atol=1e-9)
    assert any('/force were received before the clock was set' in note for note in notes)
    # The last command of the 0.9 s acts from the beginning on.
    command = series['pressure_command'].ascending()
    assert command.t[0] == pytest.approx(0.0, abs=1e-9)
    assert command.value[0] == truth['command'][1][1]
    assert kept.t[0] >= 0.0
    assert kept.t[-1] < 3.2


def test_headers_give_the_times_of_messages_before_the_first_clock(tmp_path):
    topics, truth = rig(after(START, 0), lambda since: START + since - BEGIN)
    series, _ = read(tmp_path, topics)
    t, value = truth['position']
    np.testing.assert_allclose(series['position'].value, value)
    np.testing.assert_allclose(series['position'].t - series['position'].t[0], t, atol=1e-9)
    # The force at the first time of the clock is that after 0.9 s.
    assert series['force'].t[0] - series['position'].t[0] == pytest.approx(0.9, abs=5e-3)


def test_headers_that_begin_unset_are_left_out_up_to_there(tmp_path):
    topics, truth = rig(
        lambda since: bags.EPOCH + since, lambda since: (since >= BEGIN) * (bags.EPOCH + since)
    )
    series, notes = read(tmp_path, topics)
    np.testing.assert_allclose(series['position'].value, truth['position'][1][180:])
    assert (
        '180 of 800 messages of /joint_states were stamped before the clock was set'
        in ' '.join(notes)
    )


def test_a_bag_whose_recorder_never_had_a_time(tmp_path):
    topics, _ = rig(lambda since: 0, lambda since: START + since)
    with pytest.raises(
        RecordingError, match=r'of /(force|pressure_command) were received at time 0'
    ):
        read(tmp_path, topics)


@pytest.mark.parametrize('tick', [10**9, 2 * 10**7])
def test_stamps_that_are_coarser_than_the_receipts_are_not_used(tmp_path, tick):
    topics, _ = rig(
        lambda since: bags.EPOCH + since, lambda since: (bags.EPOCH + since) // tick * tick
    )
    series, notes = read(tmp_path, topics)
    np.testing.assert_allclose(np.diff(series['position'].t), 1 / 200, atol=1e-9)
    assert series['position'].is_received
    count = 4 * 10**9 // tick
    assert f'the 800 messages of /joint_states have only {count} different stamps' in ' '.join(
        notes
    )


def test_times_of_receipt_on_request(tmp_path):
    topics, _ = rig(lambda since: bags.EPOCH + since + 10**8, lambda since: bags.EPOCH + since)
    by_header, _ = read(tmp_path, topics)
    (tmp_path / 'other').mkdir()
    received, notes = read(tmp_path / 'other', topics, 'received')
    assert notes == []
    assert all(one.is_received for one in received.values())
    for name, delay in (('position', 0.1 + LATE), ('force', 0.0)):
        moved = received[name].t - by_header[name].t
        np.testing.assert_allclose(moved, delay, atol=1e-8)


def test_times_of_receipt_exist_only_in_bags(tmp_path):
    path = tmp_path / 'a.csv'
    path.write_text('t_s,position_m\n0,0\n')
    with pytest.raises(RecordingError, match=r'time = received, but recording .* is not a bag'):
        read_recording(path, time='received')
    with pytest.raises(ParameterError, match="time = 'sent'"):
        read_recording(path, time='sent')
