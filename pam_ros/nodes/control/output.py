# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a controller publishes its pressures on: of one muscle, of both of a pair, of each."""

from array import array
from collections.abc import Sequence
from math import isfinite
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Float64, Float64MultiArray, MultiArrayDimension

from pam_ros.nodes.common.qos import DEPTH, open_qos


def _publisher(node: Node, kind: type, topic: str) -> Any:
    return node.create_publisher(
        kind, topic, QoSProfile(depth=DEPTH), qos_overriding_options=open_qos()
    )


class OneCommand:
    """The pressure of one muscle."""

    def __init__(self, node: Node, topic: str = 'pressure_command') -> None:
        """Create the publisher on *node*."""
        self._message = Float64()
        self._publisher = _publisher(node, Float64, topic)

    def publish(self, pressure: float) -> None:
        """Command *pressure* in Pa."""
        self._message.data = pressure
        self._publisher.publish(self._message)


class ArrayCommand:
    """The pressures of several muscles in one array."""

    def __init__(self, node: Node, muscles: Sequence[str]) -> None:
        """Create the publisher on *node*; the label of the array names the *muscles*."""
        size = len(muscles)
        self._message = Float64MultiArray()
        self._message.layout.dim = [
            MultiArrayDimension(label=','.join(muscles), size=size, stride=size)
        ]
        self._publisher = _publisher(node, Float64MultiArray, 'pressure_commands')

    def publish(self, pressures: Sequence[float]) -> None:
        """Command *pressures* in Pa, muscles in order."""
        self._message.data = array('d', pressures)
        self._publisher.publish(self._message)


class EachCommand:
    """The pressure of each muscle on a topic below its name."""

    def __init__(self, node: Node, muscles: Sequence[str]) -> None:
        """Create the publishers on *node*."""
        self._each = [OneCommand(node, f'{name}/pressure_command') for name in muscles]

    def publish(self, pressures: Sequence[float]) -> None:
        """Command *pressures* in Pa, muscles in order."""
        for command, pressure in zip(self._each, pressures, strict=True):
            command.publish(pressure)


def is_finite(pressure: Any) -> bool:
    """Say whether a pressure, or each of several, is a number."""
    return all(map(isfinite, pressure)) if isinstance(pressure, tuple) else isfinite(pressure)
