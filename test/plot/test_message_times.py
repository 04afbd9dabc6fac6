# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The times of messages of a running rig: stamps, or times of sending on the same axis."""

import pytest

from pam_ros.plot.message_times import RECENT, Arrived, MessageTimes

MS, SECOND = 10**6, 10**9
EPOCH = 1_750_000_000 * SECOND  # ns, of the system's clock


def wall(t):
    return EPOCH + round(t * SECOND)


def sim(t):
    return SECOND + round(t * SECOND)


def state(stamp, t, topic='joint_states', late=0.0):
    return Arrived(topic, stamp, wall(t), wall(t + late))


def command(t, late=0.0):
    return Arrived('pressure_command', 0, wall(t), wall(t + late))


def test_stamps_of_the_system_are_used_however_late_they_are_received():
    times = MessageTimes(is_simulated=False)
    prompt = [state(wall(t), t, late=1e-3) for t in (0.0, 0.1)]
    assert times.of(prompt).times == [wall(0.0), wall(0.1)]
    late = [state(wall(0.2), 0.2, late=0.9), command(0.2, late=0.9)]
    assert times.of(late).times[0] == wall(0.2)
    assert times.note == ''
    assert not times.has_own_clock


def test_a_command_has_the_time_of_its_sending_on_a_busy_machine():
    """It is received half a second late, like all others: it does not move behind the states."""
    times = MessageTimes(is_simulated=False)
    assert times.of([command(0.0, late=1e-3)]).times == [wall(1e-3)]
    assert times.of([command(1.0, late=0.5)]).times == [wall(1.001)]


def test_a_rig_in_simulated_time_is_drawn_in_it():
    """In lockstep a command follows the state that it answers, and the rig waits."""
    times = MessageTimes(is_simulated=False)
    arrived = []
    for k in range(50):
        arrived += [state(sim(0.01 * k), 0.001 * k), command(0.001 * k + 1e-4)]
    placed = times.of(arrived[:60]).times + times.of(arrived[60:]).times
    expected = [sim(0.01 * k) for k in range(50)]
    assert placed[::2] == expected
    for time, state_time in zip(placed[1::2], expected, strict=True):
        assert 0 <= time - state_time <= 1.01 * MS
    assert times.has_own_clock
    assert times.newest == placed[-1] or times.newest == expected[-1]
    assert times.note == ''


@pytest.mark.parametrize('is_simulated', [False, True])
def test_commands_are_at_the_time_of_clock(is_simulated):
    times = MessageTimes(is_simulated=is_simulated)
    for k in range(3):
        times.tell(wall(0.1 * k), sim(k))
    placed = times.of([state(sim(1.0), 0.1), command(0.15), command(0.5)])
    assert placed.times == [sim(1.0), sim(1.5), sim(2.0)]
    assert times.has_own_clock is not is_simulated


def test_without_clock_simulated_time_is_not_known():
    times = MessageTimes(is_simulated=True)
    assert times.of([command(0.0)]).times == [None]


def test_a_stamp_of_zero_is_none():
    times = MessageTimes(is_simulated=False)
    assert times.of([state(0, 0.0, late=1e-3)]).times == [wall(1e-3)]
    times = MessageTimes(is_simulated=True)
    times.tell(wall(0.0), sim(5.0))
    assert times.of([state(0, 0.5)]).times == [sim(5.0)]


def test_stamps_of_another_clock_are_not_used():
    times = MessageTimes(is_simulated=False)
    placed = times.of([state(wall(-60.0), 0.0), state(wall(1.0), 1.0, 'pam_control/state')])
    assert placed.times == [wall(0.0), wall(1.0)]
    assert times.note.startswith('joint_states was stamped by a clock 60 s behind that of this')


def test_one_node_in_simulated_time_and_one_on_the_wall():
    times = MessageTimes(is_simulated=False)
    assert times.of([state(sim(1.0), 0.0)]) == ([sim(1.0)], False)
    other = state(wall(1.0), 1.0, 'pam_control/state')
    # The axis changes: what was drawn is of another time.
    assert times.of([other, state(sim(2.0), 1.1)]) == ([wall(1.0), wall(1.1)], True)
    assert times.note == (
        'joint_states has stamps in simulated time, and pam_control/state in real time: all '
        'messages have the time at which they were sent'
    )
    # The other one has ended.
    late = 1.0 + 2.0 * RECENT / SECOND
    assert times.of([state(sim(3.0), late)]) == ([sim(3.0)], True)
    assert times.note == ''


def test_simulated_time_of_this_program_and_stamps_of_the_wall():
    times = MessageTimes(is_simulated=True)
    times.tell(wall(0.0), sim(0.0))
    times.tell(wall(1.0), sim(10.0))
    assert times.of([state(wall(0.5), 0.5)]).times == [sim(5.0)]
    assert times.note.startswith('joint_states has stamps of another clock than /clock')


def test_a_simulation_that_starts_again_begins_again():
    times = MessageTimes(is_simulated=False)
    times.of([state(sim(50.0), 0.0), state(sim(50.0), 0.0, 'pressure')])
    placed = times.of(
        [
            state(sim(50.1), 1.0),
            state(sim(0.0), 2.0),
            # It is late, but by little.
            state(sim(49.9), 2.0, 'pressure'),
            state(sim(0.1), 3.0),
            state(sim(0.1), 3.0, 'pressure'),
        ]
    )
    assert placed.begins_again
    assert placed.times[-1] == sim(0.1)
    assert placed.times[:3] == [None, None, None]
    assert times.newest == sim(0.1)


def test_messages_out_of_order_do_not_begin_again():
    times = MessageTimes(is_simulated=False)
    placed = times.of([state(wall(0.2), 0.0, late=0.3), state(wall(0.1), 0.01, late=0.3)])
    assert placed == ([wall(0.2), wall(0.1)], False)
