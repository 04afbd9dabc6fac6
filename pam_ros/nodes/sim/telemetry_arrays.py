# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics on which several muscles publish their state in arrays."""

from array import array
from collections.abc import Sequence

from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, MultiArrayDimension

from pam_ros.nodes.common.qos import open_qos
from pam_ros.simulator.plant import PlantReading
from pam_ros.timing.pace import SECOND


class ArrayTelemetry:
    """Publishes all joints in one JointState, and one array per quantity, muscles in order."""

    def __init__(
        self, node: Node, depth: int, joints: Sequence[str], muscles: Sequence[str]
    ) -> None:
        """Create the publishers on *node*; the labels of the arrays name the *muscles*."""
        self._joint = JointState(name=list(joints))
        for name in ('position', 'velocity', 'effort'):
            setattr(self._joint, name, array('d', bytes(8 * len(joints))))

        def publisher(kind: type, name: str):
            return node.create_publisher(
                kind, name, QoSProfile(depth=depth), qos_overriding_options=open_qos()
            )

        self._publish_states = publisher(JointState, 'joint_states').publish
        self._arrays = []
        for name in ('pressures', 'forces', 'stiffnesses', 'dampings'):
            message = Float64MultiArray(data=array('d', bytes(8 * len(muscles))))
            size = len(muscles)
            message.layout.dim = [
                MultiArrayDimension(label=','.join(muscles), size=size, stride=size)
            ]
            publish = publisher(Float64MultiArray, name).publish
            self._arrays.append((publish, message))

    def describe(self, frame: str, variance: float) -> None:
        """Set the frame in the header; an array has no variance."""
        self._joint.header.frame_id = frame

    def publish(self, stamp: int, reading: PlantReading, absolute: Sequence[float]) -> None:
        """Publish one state of the given ROS time in ns; *absolute* are the pressures in Pa."""
        joint = self._joint
        joint.header.stamp.sec, joint.header.stamp.nanosec = divmod(stamp, SECOND)
        joint.position[:] = array('d', reading.position)
        joint.velocity[:] = array('d', reading.velocity)
        joint.effort[:] = array('d', reading.effort)
        self._publish_states(joint)
        quantities = absolute, reading.force, reading.stiffness, reading.damping
        for (publish, message), values in zip(self._arrays, quantities, strict=True):
            message.data[:] = array('d', values)
            publish(message)
