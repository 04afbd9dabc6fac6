# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node of ``pam_sim``: its topics and services are listed there."""

import math
from time import monotonic_ns, time_ns

import numpy as np
from rclpy.qos import QoSProfile
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from pam_ros.nodes.diagnostics import ERROR, OK, WARN, Diagnostics, Health
from pam_ros.nodes.pace import Pace
from pam_ros.nodes.parameters import NodeParameters, given
from pam_ros.nodes.pressure_input import PressureInput
from pam_ros.nodes.sim_settings import Simulation, simulation, table
from pam_ros.nodes.spin import TickingNode
from pam_ros.nodes.telemetry import DEPTH, Telemetry, open_qos
from pam_ros.nodes.ticker import Ticker
from pam_ros.rig.rig import Rig
from pam_ros.rig.sensors import Feedback


class PamSim(TickingNode):
    """A rig that follows ROS time step by step, hears commands and tells its state."""

    def __init__(self) -> None:
        """Make the rig that the parameters describe, at its initial state."""
        super().__init__('pam_sim')
        self._clock_of_node = self.get_clock()
        self._given = NodeParameters(
            self, table(given(self).get('muscle', '')), simulation, self._change
        )
        self._told = self._given.built
        settings = self._told.settings
        self._telemetry = Telemetry(self, settings.joint_name)
        self._telemetry.describe(settings.frame_id, self._told.sensors.pressure_noise**2)
        self._input = PressureInput(self._told.model.muscle)
        self._rig = Rig([self._told.model], 1.0 / settings.physics_rate)
        self._feedback = Feedback(self._told.sensors)
        self._pace = Pace(settings.physics_rate, self._ros_ns(), monotonic_ns())
        self._is_paused = False
        self._published = 0
        self._begin()
        self._rig.outputs()  # compiled code is loaded at its first call
        self._rig.advance(0)
        self.create_subscription(
            Float64,
            'pressure_command',
            self._command,
            QoSProfile(depth=DEPTH),
            qos_overriding_options=open_qos(),
        )
        self.create_service(Trigger, '~/reset', self._reset)
        self.create_service(SetBool, '~/pause', self._pause)
        self._diagnostics = Diagnostics(self, {'timing': self._timing, 'commands': self._commands})
        self._given.refuse_mistyped()
        self.ticker = Ticker(settings.publish_rate)

    def start(self) -> None:
        """Let simulated time begin now."""
        super().start()
        self._begin()

    def _begin(self) -> None:
        """Go to the initial state, now."""
        pressure, position, velocity = self._told.initial
        self._rig.reset([pressure], [position], [velocity])
        self._feedback = Feedback(self._told.sensors)
        self._step = 0
        self._next = 0  # the step of the next sample
        self._sample = 0
        self._ordered = pressure  # Pa, what the valve was last told
        self._heard: float | None = None  # simulated time of the last good command
        self._is_silent = False
        self._fault = ''
        self._pace.align(0, self._ros_ns(), monotonic_ns())

    # Time ----------------------------------------------------------------------------------

    @property
    def _follows_clock(self) -> bool:
        """Whether ROS time comes from ``/clock``."""
        return self._clock_of_node.ros_time_is_active

    def _ros_ns(self) -> int:
        # Otherwise it is the system's, which is cheaper to ask itself.
        return self._clock_of_node.now().nanoseconds if self._follows_clock else time_ns()

    def tick(self) -> None:
        """Simulate what is due and publish."""
        if self._is_paused:
            self._publish(self._ros_ns())
            return
        self._run_to_now()
        if not self._follows_clock:
            # Wake up when the next sample is due: its grid moves with ROS time and each reset.
            self.ticker.aim(self._pace.steady_time(self._next))

    def _run_to_now(self) -> None:
        """Simulate what is due, and publish each sample that is due on the way."""
        if self._is_paused:
            return
        due = self._pace.due(self._step, self._ros_ns(), monotonic_ns(), self._follows_clock)
        try:
            while self._next <= due:
                self._advance(self._next)
                self._publish(self._pace.stamp(self._next))
                self._aim_at_sample(self._sample + 1)
            self._advance(due)
        except (ArithmeticError, ValueError) as error:  # the kernel's own as plain Python
            self._stop_at_fault(error)

    def _aim_at_sample(self, sample: int) -> None:
        """Let this sample, counted from the start, be the next one."""
        settings = self._told.settings
        self._sample = sample
        self._next = math.ceil(sample * settings.physics_rate / settings.publish_rate - 1e-9)

    def _advance(self, step: int) -> None:
        if step > self._step:
            self._rig.advance(step - self._step)
            self._step = step
            self._watch_silence()

    def _watch_silence(self) -> None:
        settings = self._told.settings
        if self._heard is None or self._is_silent or not settings.command_timeout:
            return
        if self._rig.time - self._heard > settings.command_timeout:
            self._is_silent = True
            if settings.on_timeout == 'vent':
                self._order(0.0)

    def _order(self, pressure: float) -> None:
        """Tell the valve a pressure in Pa from now on."""
        self._ordered = self._input.within_limits(pressure)
        self._rig.command([self._ordered])

    # Out -----------------------------------------------------------------------------------

    def _publish(self, stamp: int) -> None:
        rig = self._rig
        force, stiffness, damping, acceleration = rig.outputs()[0].tolist()
        position, velocity = rig.position.item(), rig.velocity.item()
        pressure = rig.pressure.item()
        if not (abs(position) < self._told.reach and math.isfinite(force + velocity)):
            raise ArithmeticError(f"at {position:g} m it is out of the muscle's reach")
        if not self._feedback.is_ideal:
            sample = np.array([[position], [velocity], [pressure], [force], [acceleration]])
            reading = self._feedback.read(rig.time, sample)
            position, velocity, pressure, force = reading[:, 0].tolist()
        absolute = pressure + self._told.settings.ambient_pressure
        self._telemetry.publish(stamp, position, velocity, absolute, force, stiffness, damping)
        self._published += 1

    def _stop_at_fault(self, error: Exception) -> None:
        """Stand still at the initial state: what the model says now is no motion."""
        time = self._rig.time
        self._begin()
        self._is_paused = True
        self._fault = f'the load is lost {time:.3f} s after the start, {error}: reset and paused'
        self.get_logger().error(self._fault)

    # In ------------------------------------------------------------------------------------

    def _command(self, message: Float64) -> None:
        pressure = self._input.take(message.data)
        if pressure is None:
            self.get_logger().warning(self._input.reason, throttle_duration_sec=1.0)
            return
        if pressure != message.data:
            self.get_logger().warning(self._input.reason, throttle_duration_sec=1.0)
        self._run_to_now()
        self._order(pressure)
        self._heard = self._rig.time
        self._is_silent = False

    def _change(self, now: Simulation) -> None:
        """Go on with other parameters."""
        self._run_to_now()
        before, self._told = self._told.settings.publish_rate, now
        self._rig.change([now.model])
        self._feedback.change(now.sensors)
        self._input.muscle = now.model.muscle
        self._order(self._ordered)  # the limits may have changed
        self._telemetry.describe(now.settings.frame_id, now.sensors.pressure_noise**2)
        rate = now.settings.publish_rate
        if rate != before:
            self.ticker.start(rate, monotonic_ns())
            self._aim_at_sample(math.ceil(self._rig.time * rate))

    def _reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._begin()
        response.success, response.message = True, 'at the initial state'
        return response

    def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._run_to_now()
        if self._is_paused and not request.data:
            self._pace.align(self._step, self._ros_ns(), monotonic_ns())
            self._fault = ''
        self._is_paused = request.data
        response.success, response.message = True, 'paused' if request.data else 'running'
        return response

    # Health --------------------------------------------------------------------------------

    def _timing(self) -> Health:
        kept = self.ticker.report(monotonic_ns())
        rate, self._published = self._published / kept.span, 0
        wanted = self._told.settings.publish_rate
        values = {
            'publish rate (Hz)': rate,
            'wanted publish rate (Hz)': wanted,
            'overruns': kept.overruns,
            'worst lateness (s)': kept.worst,
            'simulated time (s)': self._rig.time,
            'simulated time lost (s)': self._pace.lost,
            'clock jumps': self._pace.jumps,
            'paused': self._is_paused,
        }
        if self._fault:
            return Health(ERROR, self._fault, values)
        if self._follows_clock and not self._ros_ns():
            return Health(WARN, 'waits for /clock (use_sim_time is set)', values)
        if self._is_paused:
            return Health(OK, 'paused', values)
        if rate < 0.95 * wanted and not self._follows_clock:
            return Health(WARN, f'publishes at {rate:.1f} Hz instead of {wanted:g}', values)
        return Health(OK, 'keeps its rate', values)

    def _commands(self) -> Health:
        age = None if self._heard is None else self._rig.time - self._heard
        values = {
            'command age (s)': age,
            'last command (Pa)': self._input.last,
            'accepted': self._input.accepted,
            'clamped': self._input.clamped,
            'refused': self._input.refused,
            'last reason': self._input.reason,
        }
        if age is None:
            return Health(OK, 'no command yet', values)
        if self._is_silent:
            did = {'vent': 'vented', 'hold': 'held'}[self._told.settings.on_timeout]
            return Health(WARN, f'no command for {age:.3g} s: {did}', values)
        return Health(OK, 'commanded', values)
