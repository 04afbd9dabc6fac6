# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""All topics that the simulator publishes on its rig and on its time."""

from rclpy.node import Node
from rosgraph_msgs.msg import Clock

from pam_ros.nodes.common.qos import KEPT_SIMULATED, states_depth
from pam_ros.nodes.sim.muscle_states import MuscleStates
from pam_ros.nodes.sim.telemetry import MuscleTelemetry
from pam_ros.nodes.sim.telemetry_arrays import ArrayTelemetry
from pam_ros.settings.scene import SimulationSetup
from pam_ros.simulator.plant import PlantReading
from pam_ros.timing.pace import SECOND


class Output:
    """The topics of one muscle or of several, and ``/clock`` if the simulator makes the time."""

    def __init__(self, node: Node, setup: SimulationSetup) -> None:
        """Create the publishers on *node*."""
        self._logger = node.get_logger()
        settings = setup.settings
        if settings.has_own_time:
            self._clock = Clock()
            self._clock_publisher = node.create_publisher(Clock, '/clock', KEPT_SIMULATED)
        depth = states_depth(settings.publish_rate, is_simulated=settings.has_own_time)
        names = setup.muscle_names
        self._telemetry: list[ArrayTelemetry | MuscleTelemetry | MuscleStates] = []
        if setup.has_arrays:
            self._telemetry.append(ArrayTelemetry(node, depth, setup.joint_names, names))
        if setup.muscle_prefixes:
            self._telemetry.append(
                MuscleTelemetry(node, depth, setup.muscle_prefixes, setup.muscle_joints)
            )
        self._telemetry.append(MuscleStates(node, depth, names))
        self.describe(setup)

    def describe(self, setup: SimulationSetup) -> None:
        """Publish from now on with the frame, variance and ambient pressure of these settings."""
        settings = setup.settings
        self._ambient = settings.ambient_pressure
        frame, variance = settings.frame_id, setup.sensors.pressure_noise**2
        for telemetry in self._telemetry:
            telemetry.describe(frame, variance)

    def report(self, fault: str) -> None:
        """Log a fault of the simulation."""
        self._logger.error(fault)

    def publish_clock(self, stamp: int) -> None:
        """Publish the simulated time *stamp* in ns."""
        self._clock.clock.sec, self._clock.clock.nanosec = divmod(stamp, SECOND)
        self._clock_publisher.publish(self._clock)

    def publish(self, stamp: int, reading: PlantReading) -> None:
        """Publish one state of the given ROS time in ns."""
        absolute = [pressure + self._ambient for pressure in reading.pressure]
        for telemetry in self._telemetry:
            telemetry.publish(stamp, reading, absolute)
