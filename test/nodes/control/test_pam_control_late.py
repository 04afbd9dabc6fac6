# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joint states that arrive late according to their stamps."""

import time
from collections import deque

import pytest
from sensor_msgs.msg import JointState

from pam_ros.timing.pace import SECOND
from support.control_watch import Watch
from support.harness import Program

PERIOD = SECOND // 200
AHEAD = 3600 * SECOND  # the clock of the rig less that of this computer


class Rig:
    """A load that does not move, whose states arrive ``late`` ns after they were measured."""

    def __init__(self, peer):
        self.peer, self.late = peer, 0
        self.measured, self.queue = time.time_ns(), deque()

    def work(self):
        """Publish what is due."""
        now = time.time_ns()
        while self.measured + PERIOD <= now:
            self.measured += PERIOD
            self.queue.append(self.measured)
        while self.queue and self.queue[0] + self.late <= now:
            message = JointState(name=['pam'], position=[0.06])
            stamp = divmod(self.queue.popleft() + AHEAD, SECOND)
            message.header.stamp.sec, message.header.stamp.nanosec = stamp
            self.peer.publish(message, 'joint_states')

    def until(self, condition, what):
        def is_so():
            self.work()
            return condition()

        self.peer.until(is_so, what)


@pytest.fixture
def watch(peer):
    return Watch(peer)


@pytest.fixture
def rig(peer):
    return Rig(peer)


def statuses(watch):
    """Return what the diagnostics said of the control, the last one first."""
    found = (s for one in watch.arrays for s in one.status if s.name == 'pam_control: control')
    return list(found)[::-1]


def told(watch, words):
    """Return the last status whose message contains *words*, None without one."""
    return next((status for status in statuses(watch) if words in status.message), None)


def values(status):
    return {pair.key: pair.value for pair in status.values}


@pytest.mark.at_any_pace
def test_late_states_are_not_used_and_this_is_told(rig, watch):
    with Program('pam_control', parameters={'state_timeout': 60.0}):
        rig.until(lambda: len(watch.terms) > 100, 'control')
        rig.late = 3 * SECOND // 10
        rig.until(lambda: told(watch, 'were late according to their stamps'), 'a warning')
        status = told(watch, 'were late according to their stamps')
        assert values(status)['state'] == 'running'

        def are_counted():
            return int(values(statuses(watch)[0])['late joint_states']) > 20

        rig.until(are_counted, 'the number of late states')
        rig.late = 0
        rig.until(lambda: statuses(watch)[0].message == 'controlling', 'control as usual')


@pytest.mark.at_any_pace
def test_states_that_are_later_than_the_timeout_count_as_none_and_this_is_the_reason(rig, watch):
    with Program('pam_control', parameters={'state_timeout': 0.5}) as control:
        rig.until(lambda: len(watch.terms) > 100, 'control')
        rig.late = 3 * SECOND
        words = 'joint_states has stopped: vents: joint_states arrives 2.'
        rig.until(lambda: told(watch, words), 'the reason')
        before = len(watch.terms)
        rig.late = 0
        rig.until(lambda: len(watch.terms) > before, 'control again')
        assert 'Traceback' not in control.output
