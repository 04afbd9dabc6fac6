# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node of ``pam_control``: its topics and services are listed there."""

from time import monotonic_ns, time_ns

from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectory

from pam_ros.control.loop import BLIND, DISABLED, RUNNING, Loop
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.control.trajectory import Point
from pam_ros.errors import PamError, RangeError
from pam_ros.nodes.control_settings import Control, control, table
from pam_ros.nodes.control_state import ControlState
from pam_ros.nodes.diagnostics import ERROR, OK, WARN, Diagnostics, Health
from pam_ros.nodes.joint_input import SECOND, JointInput
from pam_ros.nodes.parameters import NodeParameters, given
from pam_ros.nodes.spin import TickingNode
from pam_ros.nodes.telemetry import DEPTH, open_qos
from pam_ros.nodes.ticker import Ticker

EARLY = 0.99  # of a period of simulated time, after which a state is answered by a new command
PATIENCE = 2.0  # periods of simulated time without a state, after which /clock alone is enough
BACK = SECOND // 10  # ns by which ROS time must go back for it to be a jump


class PamControl(TickingNode):
    """A position law that is told where to go, sees the joint and commands a pressure."""

    def __init__(self) -> None:
        """Make the law that the parameters describe; it waits for a joint state."""
        super().__init__('pam_control')
        self._ros_clock = self.get_clock()
        self._given = NodeParameters(
            self, table(given(self).get('muscle', '')), control, self._change
        )
        self._told = told = self._given.built
        settings = told.settings
        self._loop = Loop(told.law(), told.course(), told.period)
        self._loop.timeout, self._loop.safe = settings.state_timeout, settings.on_timeout
        self._loop.enable(settings.enabled)
        self._joint = JointInput(settings.joint_name)
        self._last = 0  # ROS time of the last tick, ns
        self._shown = 0  # ROS time of the last message on ~/state, ns
        self._commands = self._saturated = self._refused = self._worst = 0
        self._refusal = ''
        self._command = Float64()
        self._open_topics()
        self.create_service(SetBool, '~/enable', self._enable)
        self._diagnostics = Diagnostics(
            self, {'timing': self._timing, 'joint': self._seeing, 'control': self._controlling}
        )
        self._given.refuse_mistyped()
        self.ticker = Ticker(settings.control_rate)

    def _open_topics(self) -> None:
        open_ = open_qos
        reliable = QoSProfile(depth=DEPTH)
        sensor = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._publisher = self.create_publisher(
            Float64, 'pressure_command', reliable, qos_overriding_options=open_()
        )
        self._state = ControlState(self)
        for kind, topic, callback, quality in (
            (JointState, 'joint_states', self._see, sensor),
            (FluidPressure, 'pressure', self._see_pressure, sensor),
            (Float64, 'position_reference', self._tell, reliable),
            (JointTrajectory, 'joint_trajectory', self._play, reliable),
        ):
            self.create_subscription(
                kind, topic, callback, quality, qos_overriding_options=open_()
            )

    # Time ----------------------------------------------------------------------------------

    @property
    def _follows_clock(self) -> bool:
        """Whether ROS time comes from ``/clock``."""
        return self._ros_clock.ros_time_is_active

    def _now(self) -> int:
        # Otherwise it is the system's, which is cheaper to ask itself.
        return self._ros_clock.now().nanoseconds if self._follows_clock else time_ns()

    def tick(self) -> None:
        """Command a pressure; in simulated time only where joint states do not set the pace."""
        now = self._now()
        if self._follows_clock:
            late = now - self._last > PATIENCE * self._told.period * SECOND
            if not late and now - self._last > -BACK:
                return
        self._step(now)

    def _step(self, now: int) -> None:
        """Let the loop tick at ROS time *now* in ns."""
        if now - self._last < -BACK:
            self._loop.forget()
        self._last = now
        pressure = self._loop.tick(now / SECOND)
        if pressure is not None:
            self._publish(pressure)
        if self._loop.state == RUNNING:
            terms = self._loop.law.terms
            self._saturated += terms.saturated
            if now - self._shown >= SECOND / self._told.settings.state_rate or now < self._shown:
                self._shown = now
                self._state.publish(now, terms)

    def _publish(self, pressure: float) -> None:
        self._command.data = pressure
        self._publisher.publish(self._command)
        self._commands += 1

    # In ------------------------------------------------------------------------------------

    def _see(self, message: JointState) -> None:
        now = self._now()
        reading = self._joint.take(message, now)
        if reading is None:
            self.get_logger().error(self._joint.problem, throttle_duration_sec=1.0)
            return
        self._loop.see(reading)
        if self._follows_clock:
            self._answer(round(reading.time * SECOND))

    def _answer(self, time: int) -> None:
        """Answer a state of simulated *time* in ns, for a simulator may wait for that.

        A new command once a period has passed, else the last one again: the simulation is the
        same however fast this program runs.
        """
        if abs(time - self._last) >= EARLY * self._told.period * SECOND:
            self._step(time)
        elif self._loop.state == RUNNING and self._loop.pressure is not None:
            self._publish(self._loop.pressure)

    def _see_pressure(self, message: FluidPressure) -> None:
        gauge = message.fluid_pressure - self._told.settings.ambient_pressure
        self._loop.chamber = gauge if abs(gauge) < 1e8 else None

    def _tell(self, message: Float64) -> None:
        try:
            self._demand_running()
            self._loop.course.tell(message.data)
        except PamError as error:
            self._refuse(str(error))

    def _play(self, message: JointTrajectory) -> None:
        try:
            self._demand_running()
            stamp = message.header.stamp
            begin = stamp.sec * SECOND + stamp.nanosec
            wait = (begin - self._now()) / SECOND if begin else 0.0
            self._loop.course.play(points_of(message, self._joint.name), wait)
        except PamError as error:
            self._refuse(str(error))

    def _demand_running(self) -> None:
        """Raise RangeError where no reference can be taken: nobody knows where the load is."""
        if self._loop.state != RUNNING:
            why = {DISABLED: 'it is disabled', BLIND: 'joint_states is silent'}
            raise RangeError(
                'a reference was refused: '
                + why.get(self._loop.state, 'no joint state has come yet')
            )

    def _refuse(self, why: str) -> None:
        self._refused += 1
        self._refusal = why
        self.get_logger().warning(why, throttle_duration_sec=1.0)

    def _enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._loop.enable(request.data)
        response.success = True
        response.message = (
            'begins where the load is' if request.data else 'commands nothing any more'
        )
        return response

    def _change(self, now: Control) -> None:
        """Go on with other parameters."""
        before, self._told = self._told, now
        loop = self._loop
        loop.timeout, loop.safe = now.settings.state_timeout, now.settings.on_timeout
        if now.needs_new_law(before):
            loop.change(now.law(), now.course())
        elif isinstance(loop.law, SlidingMode):
            loop.law.set_gains(now.gains)
        loop.course.set_shape(now.shape)

    # Health --------------------------------------------------------------------------------

    def _timing(self) -> Health:
        kept = self.ticker.report(monotonic_ns())
        rate, self._commands = self._commands / kept.span, 0
        values = {
            'command rate (Hz)': rate,
            'control rate (Hz)': self._told.settings.control_rate,
            'overruns': kept.overruns,
            'worst lateness (s)': kept.worst,
        }
        wanted = self._told.settings.control_rate
        if self._follows_clock:
            message = 'follows /clock' if self._now() else 'waits for /clock (use_sim_time is set)'
            return Health(OK if self._now() else WARN, message, values)
        if self._loop.state == RUNNING and rate < 0.95 * wanted:
            return Health(WARN, f'commands at {rate:.1f} Hz instead of {wanted:g}', values)
        return Health(OK, 'keeps its rate', values)

    def _seeing(self) -> Health:
        joint = self._joint
        values = {
            'age (s)': self._loop.age(self._now() / SECOND),
            'accepted': joint.accepted,
            'refused': joint.refused,
        }
        if joint.problem:
            return Health(ERROR, joint.problem, values)
        if self._loop.state == BLIND:
            did = {'hold': 'the pressure is held', 'vent': 'vented'}
            return Health(
                ERROR, f'joint_states is silent: {did[self._told.settings.on_timeout]}', values
            )
        return Health(OK, 'seen' if joint.accepted else 'no joint state yet', values)

    def _controlling(self) -> Health:
        terms, loop = self._loop.law.terms, self._loop
        saturated, self._saturated = self._saturated, 0
        low, high = loop.course.reach
        values = {
            'state': loop.state,
            'starts': loop.starts,
            'reference (m)': terms.reference,
            'error (m)': terms.error,
            'pressure (Pa)': loop.pressure,
            'bandwidth (1/s)': terms.bandwidth,
            'lowest reference (m)': low,
            'highest reference (m)': high,
            'steps at a limit': saturated,
            'references refused': self._refused,
            'last reason': self._refusal,
        }
        if saturated:
            return Health(WARN, 'a limit of pressure holds', values)
        return Health(OK, loop.state, values)


def points_of(message: JointTrajectory, joint: str) -> list[Point]:
    """Return the points of one joint; raises RangeError where the message has none of it."""
    names = list(message.joint_names)
    if not message.points:
        return []
    if (joint and joint not in names) or (not joint and len(names) != 1):
        raise RangeError(
            f'joint_trajectory is for {", ".join(names) or "no joint"}, not for '
            f'{joint or "one joint alone"}'
        )
    index = names.index(joint) if joint else 0
    points = []
    for n, point in enumerate(message.points):
        if len(point.positions) != len(names):
            raise RangeError(f'point {n} of the trajectory has not one position for each joint')
        time = point.time_from_start.sec + point.time_from_start.nanosec / SECOND
        points.append(
            Point(
                time,
                point.positions[index],
                point.velocities[index] if len(point.velocities) == len(names) else None,
                point.accelerations[index] if len(point.accelerations) == len(names) else None,
            )
        )
    return points
