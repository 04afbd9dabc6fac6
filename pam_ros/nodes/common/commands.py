# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of a joint's commands: one array, or one topic for each muscle."""

from array import array
from collections.abc import Sequence
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Float64, Float64MultiArray, MultiArrayDimension

from pam_ros.nodes.common.qos import answers_depth, open_qos
from pam_ros.settings.one_joint import MuscleTopics


def _publisher(node: Node, kind: type, topic: str) -> Any:
    return node.create_publisher(
        kind, topic, QoSProfile(depth=answers_depth(node)), qos_overriding_options=open_qos()
    )


class ArrayCommand:
    """The pressures of several muscles in one array."""

    def __init__(self, node: Node, topic: str, muscles: Sequence[str]) -> None:
        """Create the publisher on *node*; the label of the array names the *muscles*."""
        size = len(muscles)
        self._message = Float64MultiArray()
        self._message.layout.dim = [
            MultiArrayDimension(label=','.join(muscles), size=size, stride=size)
        ]
        self._publisher = _publisher(node, Float64MultiArray, topic)
        self.publishers = [self._publisher]

    def publish(self, pressures: Sequence[float]) -> None:
        """Command *pressures* in Pa, muscles in order."""
        self._message.data = array('d', pressures)
        self._publisher.publish(self._message)


class EachCommand:
    """The pressure of each muscle on its own topic."""

    def __init__(self, node: Node, topics: Sequence[str]) -> None:
        """Create the publishers on *node*."""
        self._message = Float64()
        self.publishers = [_publisher(node, Float64, topic) for topic in topics]

    def publish(self, pressures: Sequence[float]) -> None:
        """Command *pressures* in Pa, muscles in order."""
        for publisher, pressure in zip(self.publishers, pressures, strict=True):
            self._message.data = pressure
            publisher.publish(self._message)


def commands_of(node: Node, topics: MuscleTopics) -> ArrayCommand | EachCommand:
    """Create the publishers of *topics* on *node*."""
    if topics.is_array:
        return ArrayCommand(node, topics.commands[0], topics.muscles)
    return EachCommand(node, topics.commands)
