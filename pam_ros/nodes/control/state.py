# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The terms of the law on ``~/state``, by name."""

from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

from pam_ros.control.signals import Terms
from pam_ros.nodes.common.qos import answers_depth, open_qos
from pam_ros.timing.pace import SECOND


class StateTopic:
    """Publishes terms as positions of a JointState, a standard message of named numbers.

    It has a stamp, and PlotJuggler draws each number under its name.
    """

    def __init__(self, node: Node, names: tuple[str, ...]) -> None:
        """Create the publisher of the terms of these *names* on *node*."""
        self._names = names
        self._published = 0  # ROS time of the last message, ns
        self._message = JointState(name=names, position=[0.0] * len(names))
        self._publisher = node.create_publisher(
            JointState,
            '~/state',
            QoSProfile(depth=answers_depth(node)),
            qos_overriding_options=open_qos(),
        )

    def publish(self, stamp: int, terms: Terms, rate: float) -> None:
        """Publish the terms of the ROS time *stamp* in ns, at most *rate* times a second."""
        # Slightly early counts as due, since the stamps of samples are rounded.
        if not rate or 0 <= stamp - self._published < 0.99 * SECOND / rate:
            return
        self._published = stamp
        message = self._message
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
        message.position = [terms.value(name) for name in self._names]
        self._publisher.publish(message)
