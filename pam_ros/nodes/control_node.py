# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node of ``pam_control``: its topics and services are listed there."""

from math import floor
from time import monotonic_ns

from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectory

from pam_ros.errors import RangeError
from pam_ros.nodes import control_settings
from pam_ros.nodes.control_inputs import Sight, points_of, sight_of, stamp_of
from pam_ros.nodes.control_loop import CONTROLLING, DISABLED, FAULTY, LOST, WAITING, Loop
from pam_ros.nodes.control_settings import Told
from pam_ros.nodes.control_state import StateTopic
from pam_ros.nodes.diagnostics import ERROR, OK, WARN, Diagnostics, Health
from pam_ros.nodes.pace import SECOND
from pam_ros.nodes.parameters import NodeParameters, given
from pam_ros.nodes.spin import TickingNode
from pam_ros.nodes.telemetry import DEPTH, open_qos
from pam_ros.nodes.ticker import Ticker

WATCH_RATE = 20.0  # Hz at which time-outs are looked for where states make the time
REPEAT = SECOND // 20  # ns after which a state that comes again asks for its answer again


class PamControl(TickingNode):
    """A position law in a loop that is closed over topics.

    As ROS time goes by the system's clock, it commands at its own rate. With use_sim_time, time
    passes as the stamps of the joint states say: each new one is answered with one command.
    """

    def __init__(self) -> None:
        """Make the controller that the parameters describe."""
        super().__init__('pam_control')
        self._given: NodeParameters[Told] = NodeParameters(
            self, control_settings.table(given(self)), control_settings.build_told, self._change
        )
        self._told = self._given.built
        self._loop = Loop(self._told)
        self._is_followed = bool(self.get_parameter('use_sim_time').value)
        self._seen: int | None = None  # steady time of the newest usable state, ns
        self._stamp: int | None = None  # and its stamp
        self._blindness = ''  # why the last state was not usable
        self._refusal, self._refused, self._is_refusal_new = '', 0, False
        self._until_state = 0.0  # s until the next message on ~/state
        self._commanded = 0
        self._command = Float64()
        self._begin_grid()
        self._open_topics()
        self.create_service(SetBool, '~/enable', self._enable)
        self._diagnostics = Diagnostics(self, {'timing': self._timing, 'control': self._control})
        self._given.refuse_mistyped()
        self.ticker = Ticker(self._tick_rate)

    def _open_topics(self) -> None:
        def hear(kind: type, topic: str, callback) -> None:
            quality = QoSProfile(depth=DEPTH)
            self.create_subscription(
                kind, topic, callback, quality, qos_overriding_options=open_qos()
            )

        self._commands = self.create_publisher(
            Float64, 'pressure_command', QoSProfile(depth=DEPTH), qos_overriding_options=open_qos()
        )
        self._states = StateTopic(self)
        hear(JointState, 'joint_states', self._see)
        hear(Float64, 'position_reference', self._take_reference)
        hear(JointTrajectory, 'joint_trajectory', self._take_trajectory)

    # Time ----------------------------------------------------------------------------------

    @property
    def _tick_rate(self) -> float:
        return WATCH_RATE if self._is_followed else self._told.settings.rate

    def _begin_grid(self) -> None:
        self._zero, self._period = monotonic_ns(), 0

    def start(self) -> None:
        """Begin to command."""
        super().start()
        self._begin_grid()

    def tick(self) -> None:
        """Command; where the states make the time, only see whether they stay away."""
        if self._is_followed:
            self._watch()
            return
        now, rate = monotonic_ns(), self._told.settings.rate
        # Periods are counted, so that a late tick does not shift what is measured with the next.
        period = floor((now - self._zero) * rate / SECOND + 1e-3)
        dt = max(period - self._period, 1) / rate
        self._period = period
        age = 0.0 if self._seen is None else (now - self._seen) / SECOND
        if dt > 0.5 * self._told.settings.state_timeout:
            # This program was held up itself: what came meanwhile is still to be heard.
            age = min(age, self._told.settings.state_timeout)
        self._step(dt, age, self.get_clock().now().nanoseconds)

    def _watch(self) -> None:
        if self._seen is None or self._stamp is None:
            return
        now = self.get_clock().now().nanoseconds
        # By both clocks: /clock may be heard before the states that belong to it.
        age = min(now - self._stamp, monotonic_ns() - self._seen) / SECOND
        if age > self._told.settings.state_timeout:
            self._step(1.0 / WATCH_RATE, age, now)

    def _step(self, dt: float, age: float, stamp: int) -> None:
        before = self._loop.condition
        pressure = self._loop.step(dt, age)
        if pressure is None:
            return
        if self._loop.condition != before:
            self.get_logger().error(self._trouble())
        self._publish(pressure)
        self._until_state -= dt
        rate = self._told.settings.state_rate
        if rate and self._until_state < 1e-9:
            self._until_state = max(self._until_state + 1.0 / rate, 0.0)
            self._states.publish(stamp, self._loop.law.terms)

    def _publish(self, pressure: float) -> None:
        self._command.data = pressure
        self._commands.publish(self._command)
        self._answered = monotonic_ns()
        self._commanded += 1

    # In ------------------------------------------------------------------------------------

    def _see(self, message: JointState) -> None:
        settings = self._told.settings
        try:
            sight = sight_of(message, settings.joint_name, settings.velocity_source == 'measured')
        except RangeError as error:
            self._blindness = str(error)
            self.get_logger().warning(self._blindness, throttle_duration_sec=1.0)
            return
        self._blindness = ''
        if sight.stamp and sight.stamp == self._stamp:
            self._see_again()
            return
        passed = None if self._stamp is None else sight.stamp - self._stamp
        self._seen, self._stamp = monotonic_ns(), sight.stamp
        self._take_sight(sight, passed)

    def _take_sight(self, sight: Sight, passed: int | None) -> None:
        if self._is_followed and passed is not None and passed <= 0 and self._loop.is_controlling:
            # Simulated time begins anew, and so does what happens in it.
            self._loop.enable(False)
            self._loop.enable(True)
        self._loop.see(sight.position, sight.velocity)
        if self._is_followed:
            dt = 1.0 / self._told.settings.rate
            if passed is not None and passed > 0:
                dt = passed / SECOND
            self._step(dt, 0.0, sight.stamp)

    def _see_again(self) -> None:
        """Answer a state that is told again: in lockstep the answer was not heard."""
        last = self._loop.last
        if self._is_followed and last is not None and monotonic_ns() - self._answered > REPEAT:
            self._publish(last)

    def _take_reference(self, message: Float64) -> None:
        if self._is_ready('position_reference'):
            try:
                self._loop.course.tell(message.data)
            except RangeError as error:
                self._refuse(str(error))

    def _take_trajectory(self, message: JointTrajectory) -> None:
        if not self._is_ready('joint_trajectory'):
            return
        begin = stamp_of(message)
        wait = (begin - self.get_clock().now().nanoseconds) / SECOND if begin else 0.0
        try:
            points = points_of(message, self._told.settings.joint_name)
            self._loop.course.play(points, wait)
        except RangeError as error:
            self._refuse(str(error))

    def _is_ready(self, topic: str) -> bool:
        if not self._loop.is_controlling:
            self._refuse(f'{topic} is not taken: {self._trouble()}')
        return self._loop.is_controlling

    def _refuse(self, reason: str) -> None:
        self._refusal, self._is_refusal_new = reason, True
        self._refused += 1
        self.get_logger().warning(reason, throttle_duration_sec=1.0)

    def _enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._loop.enable(request.data)
        response.success = True
        response.message = self._trouble() or 'controlling'
        return response

    def _change(self, now: Told) -> None:
        """Go on with other parameters."""
        before, self._told = self._told, now
        self._loop.change(now)
        if before.settings.rate != now.settings.rate:
            self.ticker.start(self._tick_rate, monotonic_ns())
            self._begin_grid()

    # Health --------------------------------------------------------------------------------

    def _trouble(self) -> str:
        """Say why it does not control, '' where it does."""
        did = {'vent': 'vents', 'hold': 'holds the pressure'}[self._told.settings.on_timeout]
        why = f': {self._blindness}' if self._blindness else ''
        return {
            CONTROLLING: '',
            WAITING: 'waits for joint_states' + why,
            LOST: f'joint_states stay away: {did}' + why,
            DISABLED: 'disabled: commands nothing',
            FAULTY: 'the law gave no number: vents until ~/enable is called',
        }[self._loop.condition]

    def _control(self) -> Health:
        loop, terms, told = self._loop, self._loop.law.terms, self._told
        condition = loop.condition
        values = {
            'condition': condition,
            'controller': told.settings.controller,
            'reference (m)': terms.reference if loop.is_controlling else None,
            'error (m)': terms.error if loop.is_controlling else None,
            'command (Pa)': loop.last,
            'saturated': terms.saturated if loop.is_controlling else None,
            'lowest reference (m)': told.reach[0],
            'highest reference (m)': told.reach[1],
            'age of joint_states (s)': (
                None if self._seen is None else (monotonic_ns() - self._seen) / SECOND
            ),
            'refused': self._refused,
            'last reason': self._refusal,
        }
        is_new, self._is_refusal_new = self._is_refusal_new, False
        if condition in (LOST, FAULTY) or (condition == WAITING and self._blindness):
            return Health(ERROR, self._trouble(), values)
        if is_new:
            return Health(WARN, self._refusal, values)
        if condition == WAITING:
            return Health(WARN, self._trouble(), values)
        if condition == CONTROLLING and self._blindness:
            return Health(WARN, self._blindness, values)
        return Health(OK, self._trouble() or 'controlling', values)

    def _timing(self) -> Health:
        kept = self.ticker.report(monotonic_ns())
        rate, self._commanded = self._commanded / kept.span, 0
        wanted = self._told.settings.rate
        values = {
            'command rate (Hz)': rate,
            'wanted rate (Hz)': None if self._is_followed else wanted,
            'overruns': kept.overruns,
            'worst lateness (s)': kept.worst,
        }
        if self._is_followed:
            return Health(OK, 'answers each joint state (use_sim_time is set)', values)
        if kept.rate < 0.95 * wanted:
            return Health(WARN, f'runs at {kept.rate:.1f} Hz instead of {wanted:g}', values)
        return Health(OK, 'keeps its rate', values)
