# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A rig that has come in the place of the one that is vented: its node, or its subscriber."""

import os
import signal

import pytest
import rclpy
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from pam_ros.nodes.control.rig_watch import RigWatch
from support.harness import Peer, Program


@pytest.fixture
def publisher(peer):
    return peer.node.create_publisher(Float64, 'pressure_command', 10)


@pytest.fixture
def watch(peer, publisher):
    return RigWatch(peer.node, 'joint_states', [publisher])


def test_a_new_subscriber_is_another_rig_until_venting_begins_again(peer, publisher, watch):
    with Peer() as first:
        first.collect(Float64, 'pressure_command')
        peer.until(lambda: publisher.get_subscription_count() == 1, 'the rig')
        assert not watch.is_new(1.0)
        assert not watch.is_new(1.0)
        with Peer() as second:
            second.collect(Float64, 'pressure_command')
            peer.until(lambda: watch.is_new(1.0), 'another rig')
            assert watch.is_new(1.0)
            assert not watch.is_new(5.0)
            assert not watch.is_new(5.0)


def test_a_simulator_that_starts_after_another_has_ended_is_another_rig(peer, publisher, watch):
    with Peer() as first:
        first.collect(Float64, 'pressure_command')
        peer.until(lambda: publisher.get_subscription_count() == 1, 'the rig')
        assert not watch.is_new(1.0)
    peer.until(lambda: publisher.get_subscription_count() == 0, 'its end')
    assert not watch.is_new(1.0)
    with Peer() as second:
        second.collect(Float64, 'pressure_command')
        peer.until(lambda: watch.is_new(1.0), 'another rig')


def test_a_node_of_the_same_name_is_another_rig_before_it_subscribes(peer, publisher, watch):
    def start(context):
        rclpy.init(context=context)
        return rclpy.create_node('rig', context=context)

    contexts = rclpy.Context(), rclpy.Context()
    first = start(contexts[0])
    first.create_publisher(JointState, 'joint_states', 10)

    def is_known():
        found = peer.node.get_publishers_info_by_topic('joint_states')
        return [info.node_name for info in found] == ['rig']

    peer.until(is_known, 'the rig')
    assert not watch.is_new(1.0)
    second = start(contexts[1])
    peer.until(lambda: watch.is_new(1.0), 'another rig')
    assert publisher.get_subscription_count() == 0
    for node, context in zip((first, second), contexts, strict=True):
        node.destroy_node()
        rclpy.shutdown(context=context)


def test_a_rig_whose_process_is_stopped_receives_nothing(peer, publisher, watch):
    def is_received():
        known = watch.is_received()
        if known:
            publisher.publish(Float64(data=1e5))
        peer.work(0.002)
        return known

    with Program('pam_sim') as sim:
        peer.until(lambda: publisher.get_subscription_count() == 1, 'the rig')
        assert not watch.is_new(1.0)
        # In all longer than the time after which it would not receive.
        assert sum(is_received() for _ in range(300)) > 200
        os.kill(sim.process.pid, signal.SIGSTOP)
        peer.until(lambda: not is_received(), 'missing confirmations')
        os.kill(sim.process.pid, signal.SIGCONT)
        peer.until(is_received, 'commands again')


def test_a_subscriber_that_confirms_nothing_counts_as_a_rig_that_receives(peer, publisher, watch):
    best_effort = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
    with Peer() as rig:
        rig.node.create_subscription(Float64, 'pressure_command', print, best_effort)
        peer.until(lambda: publisher.get_subscription_count() == 1, 'the rig')
        assert not watch.is_new(1.0)
        for _ in range(10):
            publisher.publish(Float64(data=1e5))
            peer.work(0.05)  # in all longer than the time after which it would not receive
            assert watch.is_received()
