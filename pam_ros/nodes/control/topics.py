# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of a controller that only one node may publish, or that need a subscriber."""

from rclpy.node import Node
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64, Float64MultiArray

from pam_ros.control.loop import BLIND, RUNNING, Loop
from pam_ros.nodes.common.topic_watch import TopicWatch, Watched
from pam_ros.settings.control import ControlSetup


def watch_topics(node: Node, setup: ControlSetup, loop: Loop) -> TopicWatch:
    """Return the watch of the topics of *node*; *loop* shows whether commands are sent."""
    return TopicWatch(node, watched_topics(setup), lambda: loop.state in (RUNNING, BLIND))


def watched_topics(setup: ControlSetup) -> list[Watched]:
    """Return these topics: joint states, commands, and the pressures if control waits for them."""
    topics = setup.topics
    command, pressure = (
        (Float64MultiArray, Float64MultiArray) if topics.is_array else (Float64, FluidPressure)
    )
    found = [Watched(JointState, 'joint_states', (setup.settings.joint_name,))]
    found += [Watched(command, topic, is_command=True) for topic in topics.commands]
    if setup.settings.pressure_wait:
        found += [Watched(pressure, topic) for topic in topics.pressures]
    return found
