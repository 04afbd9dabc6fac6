# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics on which each simulated muscle publishes its state."""

from collections.abc import Sequence

from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from pam_ros.nodes.common.qos import open_qos
from pam_ros.simulator.plant import PlantReading
from pam_ros.timing.pace import SECOND


class MuscleTelemetry:
    """Publishes the state of each muscle, on topics of its own."""

    def __init__(
        self, node: Node, depth: int, prefixes: Sequence[str], joints: Sequence[str]
    ) -> None:
        """Create the publishers on *node*; each keeps *depth* messages.

        The names of a muscle's topics begin with its prefix. *joints* are the names of the joints
        that the muscles move, one each; empty if they share one.
        """
        self._have_joints = bool(joints)
        names = joints if joints else [''] * len(prefixes)
        self._each = [
            _OneMuscle(node, depth, prefix, joint)
            for prefix, joint in zip(prefixes, names, strict=True)
        ]

    def describe(self, frame: str, variance: float) -> None:
        """Set the frame in the headers, and the variance of the pressures in Pa^2."""
        for muscle in self._each:
            muscle.describe(frame, variance)

    def publish(self, stamp: int, reading: PlantReading, absolute: Sequence[float]) -> None:
        """Publish one state of the given ROS time in ns; *absolute* are the pressures in Pa."""
        position, velocity = reading.position, reading.velocity
        if not self._have_joints:
            position = velocity = [0.0] * len(self._each)
        force, stiffness, damping = reading.force, reading.stiffness, reading.damping
        for i, muscle in enumerate(self._each):
            of_muscle = absolute[i], force[i], stiffness[i], damping[i]
            muscle.publish(stamp, position[i], velocity[i], *of_muscle)


class _OneMuscle:
    """Publishes the state of one muscle; each message is created once and filled again."""

    def __init__(self, node: Node, depth: int, below: str, joint: str) -> None:
        """Create the publishers on *node*, without ``joint_states`` if *joint* is empty."""
        self._joint = JointState(name=[joint], position=[0.0], velocity=[0.0], effort=[0.0])
        self._fluid = FluidPressure(header=self._joint.header)
        self._float = Float64()
        self._stamp = self._joint.header.stamp

        def publisher(kind: type, name: str):
            return node.create_publisher(
                kind, below + name, QoSProfile(depth=depth), qos_overriding_options=open_qos()
            )

        self._joint_states = publisher(JointState, 'joint_states') if joint else None
        self._pressure = publisher(FluidPressure, 'pressure')
        self._force = publisher(Float64, 'force')
        self._stiffness = publisher(Float64, 'stiffness')
        self._damping = publisher(Float64, 'damping')

    def describe(self, frame: str, variance: float) -> None:
        """Set the frame in the headers, and the variance of the pressure in Pa^2."""
        self._joint.header.frame_id = frame
        self._fluid.variance = variance

    def publish(
        self,
        stamp: int,
        position: float,
        velocity: float,
        pressure: float,
        force: float,
        stiffness: float,
        damping: float,
    ) -> None:
        """Publish one state of the ROS time *stamp* in ns; *pressure* is absolute."""
        self._stamp.sec, self._stamp.nanosec = divmod(stamp, SECOND)
        joint, value = self._joint, self._float
        if self._joint_states:
            joint.position[0], joint.velocity[0], joint.effort[0] = position, velocity, force
            self._joint_states.publish(joint)
        self._fluid.fluid_pressure = pressure
        self._pressure.publish(self._fluid)
        value.data = force
        self._force.publish(value)
        value.data = stiffness
        self._stiffness.publish(value)
        value.data = damping
        self._damping.publish(value)
