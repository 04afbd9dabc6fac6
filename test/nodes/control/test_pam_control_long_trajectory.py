# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A trajectory of a minute at the rate of control comes: commands go on while it is read."""

import math

import numpy as np
import pytest
from builtin_interfaces.msg import Duration
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from support.control_watch import Watch, stamp
from support.harness import Program
from support.marks import at_release

COUNT, PERIOD = 30_000, 2_000_000  # points, ns
WAY = 0.005  # m
COMMAND_TIMEOUT = 0.5  # s without a command after which the simulator vents


def points(middle, kind):
    turn = 2.0 * math.pi * 0.2
    made = []
    for k in range(1, COUNT + 1):
        t = k * PERIOD * 1e-9
        point = JointTrajectoryPoint(positions=[middle + WAY * math.sin(turn * t)])
        if kind == 'whole':
            point.velocities = [WAY * turn * math.cos(turn * t)]
            point.accelerations = [-WAY * turn * turn * math.sin(turn * t)]
        elif kind == 'mixed' and k % 2:  # no two points after each other are alike
            point.velocities = [0.0]
        point.time_from_start = Duration(sec=k * PERIOD // 10**9, nanosec=k * PERIOD % 10**9)
        made.append(point)
    return made


@pytest.mark.parametrize('kind', [at_release('positions'), at_release('whole'), 'mixed'])
def test_commands_go_on_while_a_long_trajectory_is_read(peer, kind):
    watch = Watch(peer)
    states = peer.collect(JointState, 'joint_states')
    with (
        Program(
            'pam_sim', parameters={'initial.pressure': 300e3, 'command_timeout': COMMAND_TIMEOUT}
        ),
        Program('pam_control', parameters={'state_rate': 100.0}),
    ):
        begin = watch.begin()
        message = JointTrajectory(joint_names=['pam'], points=points(begin, kind))
        peer.more(watch.terms, 20)
        sent = stamp(watch.terms[-1])
        peer.publish(message, 'joint_trajectory')

        def longest_gap():
            return np.diff([stamp(term) for term in watch.terms if stamp(term) >= sent]).max()

        peer.more(watch.terms, 2)
        peer.until(
            lambda: (
                watch.latest('reference') > begin + 0.9 * WAY or longest_gap() > COMMAND_TIMEOUT
            ),
            'the motion',
        )
        assert longest_gap() < COMMAND_TIMEOUT
        positions = [state.position[0] for state in states if stamp(state) >= sent]
        assert min(positions) > begin - 0.2 * WAY  # it neither vents nor falls
