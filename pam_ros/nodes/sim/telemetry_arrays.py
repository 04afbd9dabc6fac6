# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics on which several muscles publish their state: arrays, and topics of each muscle."""

from array import array
from collections.abc import Sequence

import numpy as np
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, MultiArrayDimension

from pam_ros.nodes.common.qos import open_qos
from pam_ros.nodes.sim.telemetry import Telemetry
from pam_ros.simulator.plant import Reading
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
        # Views of the messages' memory, which are filled without a loop over Python numbers.
        states = self._joint.position, self._joint.velocity, self._joint.effort
        self._states = [np.frombuffer(each) for each in states]

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
            self._arrays.append((publish, message, np.frombuffer(message.data)))

    def describe(self, frame: str, variance: float) -> None:
        """Set the frame in the header; an array has no variance."""
        self._joint.header.frame_id = frame

    def publish(self, stamp: int, reading: Reading, ambient: float) -> None:
        """Publish one state of the given ROS time in ns; pressures with *ambient* Pa added."""
        header = self._joint.header.stamp
        header.sec, header.nanosec = divmod(stamp, SECOND)
        position, velocity, effort = self._states
        position[:], velocity[:] = reading.position, reading.velocity
        effort[:] = reading.effort
        self._publish_states(self._joint)
        quantities = reading.pressure + ambient, reading.force, reading.stiffness, reading.damping
        for (publish, message, memory), values in zip(self._arrays, quantities, strict=True):
            memory[:] = values
            publish(message)


class MuscleTelemetry:
    """Publishes for each muscle the topics of a single muscle, below its name.

    For a muscle with a load of its own this includes ``joint_states``.
    """

    def __init__(
        self, node: Node, depth: int, muscles: Sequence[str], *, have_loads: bool
    ) -> None:
        """Create the publishers on *node*; the joint of a load has the name of its muscle."""
        self._each = [
            Telemetry(node, depth, name, f'{name}/', has_joint=have_loads) for name in muscles
        ]
        self._have_loads = have_loads

    def describe(self, frame: str, variance: float) -> None:
        """Set the frame in the headers, and the variance of the pressures in Pa^2."""
        for telemetry in self._each:
            telemetry.describe(frame, variance)

    def publish(self, stamp: int, reading: Reading, ambient: float) -> None:
        """Publish one state of the given ROS time in ns; pressures with *ambient* Pa added."""
        nothing = np.zeros_like(reading.force)
        position, velocity = nothing, nothing
        if self._have_loads:
            position, velocity = reading.position, reading.velocity
        rows = zip(
            *(position.tolist(), velocity.tolist(), reading.pressure.tolist()),
            *(reading.force.tolist(), reading.stiffness.tolist(), reading.damping.tolist()),
            strict=True,
        )
        for telemetry, values in zip(self._each, rows, strict=True):
            telemetry.publish(stamp, values, ambient)
