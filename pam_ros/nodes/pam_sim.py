# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_sim``: a pneumatic artificial muscle with its load, simulated in real time.

Subscribes
    ``pressure_command`` (std_msgs/Float64): Pa gauge
Publishes
    ``joint_states`` (sensor_msgs/JointState): contraction in m, velocity in m/s, force in N
    ``force``, ``stiffness``, ``damping`` (std_msgs/Float64): N, N/m, N s/m
    ``pressure`` (sensor_msgs/FluidPressure): absolute Pa in the chamber
    ``/diagnostics`` (diagnostic_msgs/DiagnosticArray) once a second
Services
    ``~/reset`` (std_srvs/Trigger): back to the initial state
    ``~/pause`` (std_srvs/SetBool): stop simulated time; messages go on

Contraction is positive: the load moves up. Parameters: ``ros2 param describe``.
"""

import math
import sys
from time import monotonic_ns

import numpy as np
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from pam_ros.nodes.diagnostics import OK, WARN, Diagnostics, Health
from pam_ros.nodes.pace import SECOND, Pace
from pam_ros.nodes.parameters import NodeParameters
from pam_ros.nodes.pressure_input import PressureInput
from pam_ros.nodes.sim_settings import Simulation, simulation, table
from pam_ros.nodes.spin import run
from pam_ros.nodes.ticker import Ticker
from pam_ros.rig.rig import Rig
from pam_ros.rig.sensors import Feedback

DEPTH = 10


class PamSim(Node):
    """The simulator node."""

    def __init__(self) -> None:
        """Make the rig that the parameters describe, at its initial state."""
        super().__init__('pam_sim')
        self._parameters_of = NodeParameters(self, table(), simulation, self._change)
        self._now = self._parameters_of.built
        settings = self._now.settings
        self._input = PressureInput(self._now.model.muscle.p_max)
        self._rig = Rig([self._now.model], 1.0 / settings.physics_rate)
        self._is_paused = False
        self._pace = Pace(settings.physics_rate, self._ros_ns(), monotonic_ns())
        self._make_messages()
        self._begin()

        qos = QoSProfile(depth=DEPTH)
        options = {'qos_overriding_options': QoSOverridingOptions.with_default_policies()}
        self._joint_publisher = self.create_publisher(JointState, 'joint_states', qos, **options)
        self._pressure_publisher = self.create_publisher(FluidPressure, 'pressure', qos, **options)
        self._float_publishers = [
            self.create_publisher(Float64, name, qos, **options)
            for name in ('force', 'stiffness', 'damping')
        ]
        self.create_subscription(Float64, 'pressure_command', self._command, qos, **options)
        self.create_service(Trigger, '~/reset', self._reset)
        self.create_service(SetBool, '~/pause', self._pause)
        self._diagnostics = Diagnostics(self, {'timing': self._timing, 'commands': self._commands})
        self._parameters_of.refuse_mistyped()
        self.ticker = Ticker(settings.publish_rate, monotonic_ns())

    def _make_messages(self) -> None:
        """Make the messages once: filling them anew is cheaper than making them anew."""
        self._joint = JointState(
            name=[self._now.settings.joint_name], position=[0.0], velocity=[0.0], effort=[0.0]
        )
        self._fluid = FluidPressure()
        self._fluid.header = self._joint.header
        self._float = Float64()
        self._fill_constants()

    def _fill_constants(self) -> None:
        self._joint.header.frame_id = self._now.settings.frame_id
        self._fluid.variance = self._now.sensors.pressure_noise**2

    def _ros_ns(self) -> int:
        return self.get_clock().now().nanoseconds

    # The way of time -----------------------------------------------------------------------

    def _begin(self) -> None:
        """Go to the initial state."""
        pressure, position, velocity = self._now.initial
        self._rig.reset([pressure], [position], [velocity])
        self._feedback = Feedback(self._now.sensors)
        self._step = 0
        self._sample = 0
        self._heard: float | None = None  # simulated time of the last good command
        self._timed_out = False
        self._pace.align(0, self._ros_ns(), monotonic_ns())

    def tick(self) -> None:
        """Simulate what is due and publish."""
        if self._is_paused:
            self._publish(self._ros_ns())
            return
        self._run_to(self._due())

    def _due(self) -> int:
        is_simulated = self.get_clock().ros_time_is_active
        return self._pace.due(self._step, self._ros_ns(), monotonic_ns(), is_simulated)

    def _run_to(self, step: int) -> None:
        """Simulate up to *step*, publishing each sample that is due on the way."""
        settings = self._now.settings
        between = settings.physics_rate / settings.publish_rate
        while True:
            sample = math.ceil(self._sample * between - 1e-9)
            if sample > step:
                break
            self._advance(sample)
            self._publish(self._pace.stamp(sample))
            self._sample += 1
        self._advance(step)

    def _advance(self, step: int) -> None:
        if step > self._step:
            self._rig.advance(step - self._step)
            self._step = step
            self._watch_silence()

    def _watch_silence(self) -> None:
        settings = self._now.settings
        if self._heard is None or self._timed_out or not settings.command_timeout:
            return
        if self._rig.time - self._heard > settings.command_timeout:
            self._timed_out = True
            if settings.on_timeout == 'vent':
                self._rig.command([0.0])

    # What goes out -------------------------------------------------------------------------

    def _publish(self, stamp: int) -> None:
        force, stiffness, damping, acceleration = self._rig.outputs()[0].tolist()
        sample = np.array(
            [
                self._rig.position,
                self._rig.velocity,
                self._rig.pressure,
                [force],
                [acceleration],
            ]
        )
        position, velocity, pressure, force = self._feedback.read(self._rig.time, sample)[:, 0]
        joint, time = self._joint, self._joint.header.stamp
        time.sec, time.nanosec = divmod(stamp, SECOND)
        joint.position[0], joint.velocity[0], joint.effort[0] = position, velocity, force
        self._joint_publisher.publish(joint)
        self._fluid.fluid_pressure = pressure + self._now.settings.ambient_pressure
        self._pressure_publisher.publish(self._fluid)
        for publisher, value in zip(
            self._float_publishers, (force, stiffness, damping), strict=True
        ):
            self._float.data = float(value)
            publisher.publish(self._float)

    # What comes in -------------------------------------------------------------------------

    def _command(self, message: Float64) -> None:
        pressure = self._input.take(message.data)
        if pressure is None or pressure != message.data:
            self.get_logger().warning(self._input.reason, throttle_duration_sec=1.0)
        if pressure is None:
            return
        if not self._is_paused:
            self._run_to(self._due())
        self._rig.command([pressure])
        self._heard = self._rig.time
        self._timed_out = False

    def _change(self, now: Simulation) -> None:
        """Go on with other parameters."""
        if not self._is_paused:
            self._run_to(self._due())
        before, self._now = self._now, now
        self._rig.change([now.model])
        self._feedback.change(now.sensors)
        self._input.p_max = now.model.muscle.p_max
        rate = now.settings.publish_rate
        if rate != before.settings.publish_rate:
            self.ticker.restart(rate, monotonic_ns())
            self._sample = math.ceil(self._rig.time * rate)
        self._fill_constants()

    def _reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._begin()
        response.success = True
        response.message = 'at the initial state'
        return response

    def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        if request.data and not self._is_paused:
            self._run_to(self._due())
        elif not request.data and self._is_paused:
            self._pace.align(self._step, self._ros_ns(), monotonic_ns())
        self._is_paused = request.data
        response.success = True
        response.message = 'paused' if self._is_paused else 'running'
        return response

    # How it is doing -----------------------------------------------------------------------

    def _timing(self) -> Health:
        kept = self.ticker.report(monotonic_ns())
        wanted = self._now.settings.publish_rate
        values = {
            'publish rate (Hz)': kept.rate,
            'wanted publish rate (Hz)': wanted,
            'overruns': kept.overruns,
            'worst lateness (s)': kept.worst,
            'simulated time lost (s)': self._pace.lost,
            'clock jumps': self._pace.jumps,
            'simulated time (s)': self._rig.time,
            'paused': self._is_paused,
        }
        if kept.rate < 0.95 * wanted:
            return Health(WARN, f'publishes at {kept.rate:.1f} Hz instead of {wanted:g}', values)
        return Health(OK, 'paused' if self._is_paused else 'keeps its rate', values)

    def _commands(self) -> Health:
        age = '' if self._heard is None else self._rig.time - self._heard
        values = {
            'command age (s)': age,
            'last command (Pa)': '' if self._input.last is None else self._input.last,
            'accepted': self._input.accepted,
            'clamped': self._input.clamped,
            'refused': self._input.refused,
            'last reason': self._input.reason,
        }
        if self._heard is None:
            return Health(OK, 'no command yet', values)
        if self._timed_out:
            did = {'vent': 'vented', 'hold': 'held'}[self._now.settings.on_timeout]
            return Health(WARN, f'no command for {age:.3g} s: {did}', values)
        return Health(OK, 'commanded', values)


def main() -> None:
    """Run the simulator until Ctrl-C or SIGTERM."""
    sys.exit(run(PamSim))
