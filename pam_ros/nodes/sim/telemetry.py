# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics on which a simulated muscle publishes its state."""

from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from pam_ros.nodes.common.qos import open_qos
from pam_ros.simulator.plant import OneReading
from pam_ros.timing.pace import SECOND


class Telemetry:
    """Publishes the state of one muscle; each message is created once and filled again."""

    def __init__(
        self,
        node: Node,
        depth: int,
        joint: str,
        below: str = '',
        *,
        has_joint: bool = True,
    ) -> None:
        """Create the publishers on *node*; *joint* is the name of the joint, if there is one.

        *below* is the prefix of the names of the topics; each publisher keeps *depth* messages.
        """
        self._joint = JointState(name=[joint], position=[0.0], velocity=[0.0], effort=[0.0])
        self._fluid = FluidPressure(header=self._joint.header)
        self._float = Float64()
        self._stamp = self._joint.header.stamp

        def publisher(kind: type, name: str):
            return node.create_publisher(
                kind, below + name, QoSProfile(depth=depth), qos_overriding_options=open_qos()
            )

        self._joint_states = publisher(JointState, 'joint_states') if has_joint else None
        self._pressure = publisher(FluidPressure, 'pressure')
        self._force = publisher(Float64, 'force')
        self._stiffness = publisher(Float64, 'stiffness')
        self._damping = publisher(Float64, 'damping')

    def describe(self, frame: str, variance: float) -> None:
        """Set the frame in the headers, and the variance of the pressure in Pa^2."""
        self._joint.header.frame_id = frame
        self._fluid.variance = variance

    def publish(self, stamp: int, reading: OneReading, ambient: float) -> None:
        """Publish one state of the given ROS time in ns; the pressure with *ambient* Pa added."""
        position, velocity, pressure, force, stiffness, damping = reading
        self._stamp.sec, self._stamp.nanosec = divmod(stamp, SECOND)
        joint, value = self._joint, self._float
        if self._joint_states:
            joint.position[0], joint.velocity[0], joint.effort[0] = position, velocity, force
            self._joint_states.publish(joint)
        self._fluid.fluid_pressure = pressure + ambient
        self._pressure.publish(self._fluid)
        value.data = force
        self._force.publish(value)
        value.data = stiffness
        self._stiffness.publish(value)
        value.data = damping
        self._damping.publish(value)
