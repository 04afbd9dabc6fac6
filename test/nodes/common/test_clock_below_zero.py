# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Times of ``/clock`` below 0, which rclpy cannot represent, are left out with one warning."""

import pytest
from rclpy.duration import Duration
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64

from support.bags import contents
from support.harness import DEADLINE, Program

WARNING = '/clock has a time of -5 s, which is not allowed'


def clock(seconds):
    message = Clock()
    message.clock.sec = seconds
    return message


@pytest.mark.at_any_pace
@pytest.mark.parametrize('name', ['pam_sim', 'pam_control'])
def test_a_node_goes_on(peer, name):
    with Program(name, parameters={'use_sim_time': True}) as program:

        def warns():
            assert program.is_running, program.output
            peer.publish(clock(-5), '/clock')
            return WARNING in program.output

        peer.until(warns, 'the warning')
        for _ in range(20):
            peer.publish(clock(-5), '/clock')
            peer.publish(clock(7), '/clock')
        peer.get(name, 'use_sim_time')  # it answers
        assert program.stop() == 0
        assert program.output.count(WARNING) == 1
        assert 'Traceback' not in program.output


@pytest.mark.at_any_pace
def test_a_bag_has_no_time_below_zero(peer, tmp_path):
    bag = tmp_path / 'rig'
    topic = '/force'
    arguments = ('-p', 'use_sim_time:=true', '--', '-o', str(bag))
    with Program('pam_record', *arguments) as program:

        def warns():
            assert program.is_running, program.output
            for seconds in (3, -5):
                peer.publish(clock(seconds), '/clock')
                peer.publish(Float64(), topic)
            return WARNING in program.output

        peer.until(warns, 'the warning')
        for seconds in 20 * (3, -5):
            peer.publish(clock(seconds), '/clock')
            peer.publish(Float64(), topic)
        peer.delivered(topic, Duration(seconds=DEADLINE))
        assert program.stop() == 0
        assert 'Traceback' not in program.output
    times = {stamp for stamp, _ in contents(bag)[topic]}
    assert 3 * 10**9 in times
    assert times <= {0, 3 * 10**9}
