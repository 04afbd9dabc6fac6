# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How joint states are listened to: any publisher's in real time, all of them in lockstep."""

import pytest
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from support.harness import Program

pytestmark = pytest.mark.at_any_pace

RELIABLE, BEST_EFFORT = ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT
OVERRIDE = 'qos_overrides./joint_states.subscription.reliability'


@pytest.mark.parametrize('offered', [RELIABLE, BEST_EFFORT], ids=['reliable', 'best_effort'])
@pytest.mark.parametrize('joint', ['load', 'antagonistic'])
def test_in_real_time_a_rig_is_received_with_any_quality_of_service(peer, offered, joint):
    quality = QoSProfile(depth=10, reliability=offered)
    states = peer.node.create_publisher(JointState, 'joint_states', quality)
    terms = peer.collect(JointState, 'pam_control/state')
    given = {'joint': joint, 'pressure_wait': 0.0}
    with Program('pam_control', parameters=given):
        count = 0

        def is_controlled():
            nonlocal count
            count += 1
            message = JointState(name=['pam'], position=[0.05])
            message.header.stamp.sec = count
            states.publish(message)
            return terms

        assert peer.until(is_controlled, 'control')


@pytest.mark.parametrize(
    ('program', 'given', 'expected'),
    [
        ('pam_control', {}, BEST_EFFORT),
        ('pam_control', {'use_sim_time': True}, RELIABLE),
        ('pam_control', {'use_sim_time': True, OVERRIDE: 'best_effort'}, BEST_EFFORT),
        ('pam_control', {OVERRIDE: 'reliable'}, RELIABLE),
        ('pam_excite', {}, BEST_EFFORT),
        ('pam_excite', {'use_sim_time': True}, RELIABLE),
    ],
)
def test_where_states_make_the_time_none_may_be_lost(peer, program, given, expected):
    states = peer.node.create_publisher(JointState, 'joint_states', 10)
    peer.node.create_subscription(Float64, 'pressure_command', print, 10)
    with Program(program, parameters=given):

        def found():
            infos = peer.node.get_subscriptions_info_by_topic(states.topic_name)
            return [info.qos_profile.reliability for info in infos]

        assert peer.until(found, 'its subscription') == [expected]
