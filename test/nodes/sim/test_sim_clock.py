# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_sim`` with ``use_sim_time``: simulated time is that of ``/clock``."""

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from support.harness import Program, lose_nothing


def stamp(message):
    return message.header.stamp.sec * 1000 + message.header.stamp.nanosec // 1_000_000


@pytest.mark.at_any_pace
def test_it_follows_the_clock_and_survives_a_jump_back(peer):
    states = peer.collect(JointState, 'joint_states')
    diagnostics = peer.collect(DiagnosticArray, '/diagnostics')
    now = Clock()

    def set_clock(milliseconds):
        now.clock.sec, rest = divmod(milliseconds, 1000)
        now.clock.nanosec = rest * 1_000_000
        peer.publish(now, '/clock')

    # A message of the clock can be lost: it is published again until it is received.
    def leap(milliseconds, jumps):
        """Set the clock elsewhere, and wait for word that this was seen."""

        def seen():
            set_clock(milliseconds)
            last = [v for s in diagnostics[-1].status for v in s.values if v.key == 'clock jumps']
            return last and last[0].value == str(jumps)

        peer.until(seen, f'{jumps} clock jumps')

    def run(begin, end):
        """Move the clock on by 10 ms as often as the simulator has kept up with it."""
        for time in range(begin + 10, end + 1, 10):

            def reached(time=time):
                set_clock(time)
                return states and stamp(states[-1]) == time

            peer.until(reached, f'the state at {time} ms')

    given = {
        'use_sim_time': True,
        'initial.pressure': 600e3,
        'initial.at_rest': False,
        'initial.position': 0.0,
        **lose_nothing(),
    }
    with Program('pam_sim', parameters=given):
        peer.until(
            lambda: any('/clock' in s.message for m in diagnostics for s in m.status),
            'word that it waits for the clock',
        )
        leap(100_000, 1)
        assert {m.position[0] for m in states} <= {0.0}
        run(100_000, 100_300)
        moved = states[-1].position[0]
        assert moved > 0.05
        # Nothing moves while the clock stands still, whatever the time on the wall.
        seconds = len(diagnostics)
        peer.until(lambda: len(diagnostics) > seconds + 1, 'seconds on the wall')
        assert states[-1].position[0] == moved
        leap(50_000, 2)
        assert states[-1].position[0] == moved
        run(50_000, 50_100)
    earlier = [m for m in states if 100_000 < stamp(m) <= 100_300]
    later = [m for m in states if 50_000 < stamp(m) <= 50_100]
    assert len(earlier) == 150
    assert len(later) == 50
    # The motion goes on after the jump where it was before it.
    assert abs(later[0].position[0] - moved) < 0.005
    assert later[-1].position[0] != moved
