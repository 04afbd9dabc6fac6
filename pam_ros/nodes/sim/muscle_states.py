# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One message with a stamp for the force, stiffness, damping and pressure of the muscles."""

from array import array
from collections.abc import Sequence
from itertools import chain

from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

from pam_ros.nodes.common.qos import open_qos
from pam_ros.simulator.plant import PlantReading
from pam_ros.timing.pace import SECOND

QUANTITIES = ('force', 'stiffness', 'damping', 'pressure')


class MuscleStates:
    """Publishes ``muscle_states``: numbers named ``<muscle>/<quantity>``, as positions.

    The units are N, N/m, N s/m and absolute Pa; the muscles are in order. The values are those of
    the topics without a stamp, and the stamp is that of ``joint_states``.
    """

    def __init__(self, node: Node, depth: int, muscles: Sequence[str]) -> None:
        """Create the publisher on *node*."""
        names = [f'{muscle}/{quantity}' for muscle in muscles for quantity in QUANTITIES]
        self._message = JointState(name=names, position=array('d', bytes(8 * len(names))))
        self._publisher = node.create_publisher(
            JointState, 'muscle_states', QoSProfile(depth=depth), qos_overriding_options=open_qos()
        )

    def describe(self, frame: str, variance: float) -> None:
        """Set the frame in the header; the message has no variance."""
        self._message.header.frame_id = frame

    def publish(self, stamp: int, reading: PlantReading, absolute: Sequence[float]) -> None:
        """Publish one state of the given ROS time in ns; *absolute* are the pressures in Pa."""
        header = self._message.header.stamp
        header.sec, header.nanosec = divmod(stamp, SECOND)
        rows = zip(reading.force, reading.stiffness, reading.damping, absolute, strict=True)
        self._message.position[:] = array('d', chain.from_iterable(rows))
        self._publisher.publish(self._message)
