# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node of ``pam_control``: the help of this program lists its topics and services."""

from math import isfinite
from time import monotonic_ns

from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectory

from pam_ros.control.loop import BLIND, RUNNING, WAITING, Loop, Measurement, warm_up
from pam_ros.control.plausibility import Plausibility, bounds_of
from pam_ros.control.reference.points import Points
from pam_ros.control.reference.serialised import read_trajectory
from pam_ros.control.reference.trajectory import ReferenceTrajectory
from pam_ros.control.signals import Pressures, term_names
from pam_ros.errors import RangeError
from pam_ros.health import controller as control_health
from pam_ros.health import start_line
from pam_ros.health.health import Health
from pam_ros.health.learned import learning
from pam_ros.health.reports import Reports
from pam_ros.health.tracking import Tracking
from pam_ros.nodes.common.commands import commands_of
from pam_ros.nodes.common.diagnostics import Diagnostics
from pam_ros.nodes.common.node_parameters import NodeParameters
from pam_ros.nodes.common.rclpy_internals import overrides_of
from pam_ros.nodes.common.spin import TickingNode
from pam_ros.nodes.control.chamber_input import ChamberInput
from pam_ros.nodes.control.follow import Follow
from pam_ros.nodes.control.inputs import MeasuredState, measured_state
from pam_ros.nodes.control.intake import StateIntake
from pam_ros.nodes.control.rig_watch import RigWatch
from pam_ros.nodes.control.state import StateTopic
from pam_ros.nodes.control.topics import watch_topics
from pam_ros.settings.control import ControlSetup, settings_of
from pam_ros.timing.delay import Lateness
from pam_ros.timing.interruption import steady_ns
from pam_ros.timing.pace import SECOND
from pam_ros.timing.ticker import Ticker

# s; if a step is later than this, messages that arrived meanwhile are received first.
LATE = 0.05
WATCH_RATE = 20.0  # Hz at which timeouts are checked if time follows the states
# ns between commands that vent. A rig that is discovered between the check for a new one and the
# command receives the command: the fewer commands, the less likely. It is a little less than
# 10 ms, so that jitter leaves out no command at a rate of 100 Hz.
VENT_PERIOD = 9 * SECOND // 1000
REPEAT = SECOND // 20  # ns after a command, after which it is sent again for a repeated state


class PamControl(TickingNode):
    """A position law in a loop that is closed over topics.

    If ROS time is the system's clock, the node commands at its own rate. With use_sim_time, time
    follows the stamps of the joint states: each new state is answered with one command.
    """

    def __init__(self) -> None:
        """Create the controller that the parameters describe."""
        super().__init__('pam_control')
        self._given: NodeParameters[ControlSetup] = NodeParameters(
            self, *settings_of(overrides_of(self)), self._change
        )
        self._setup = self._given.built
        self._loop = self._make_loop()
        self._is_followed = bool(self.get_parameter('use_sim_time').value)
        self.keeps_wall_time = not self._is_followed
        self._seen = steady_ns()  # steady time of the newest usable state, ns
        self._stamp: int | None = None  # its stamp, ns
        self._last: Measurement | None = None  # its values
        self._ticked = self._seen  # steady time of the last tick, ns
        self._has_waited = False
        self._answered = 0  # steady time of the last command, ns
        self._blindness = ''  # why the last state was not usable
        self._repeated = self._seen  # steady time of the last state whose stamp was not new, ns
        self._reports, self._tracking = Reports(self.get_logger()), Tracking()
        self._intake = StateIntake(
            self,
            self._is_followed,
            lambda: self._setup.settings.longest_interruption,
            self._restart_after_pause,
        )
        self._lateness = Lateness()
        self._shown = 0  # ROS time of the last message on ~/state, ns
        self._fault = ''
        self._commanded = 0
        self._open_topics()
        self.create_service(SetBool, '~/enable', self._enable)
        self._topics = watch_topics(self, self._setup, self._loop)
        parts = {
            'timing': self._timing,
            'control': self._control,
            'learning': lambda: learning(self._loop.law.learned, self._setup.law.unit),
            'topics': self._topics.health,
        }
        self._diagnostics = Diagnostics(self, parts)
        self._goals = Follow(
            self,
            self._loop,
            lambda: self._setup,
            self._follow,
            self._trouble,
            self._reports.reject,
        )
        self._given.refuse_mistyped()
        self.ticker = Ticker(self._tick_rate)

    def _make_loop(self) -> Loop:
        setup = self._setup
        law, period = setup.law.make_law(), setup.law.period
        warm_up(law, setup.law.reach, period)
        source = setup.law.make_reference_source()
        loop = Loop(law, source, period, Plausibility(bounds_of(law.allocation)))
        _protect(loop, setup)
        loop.enable(setup.settings.start_enabled)
        return loop

    def _open_topics(self) -> None:
        intake = self._intake
        intake.measure(JointState, 'joint_states', self._see)
        intake.subscribe(Float64, 'position_reference', self._take_reference)
        # Raw: converting its points to Python objects would delay commands for too long.
        intake.subscribe(JointTrajectory, 'joint_trajectory', self._take_trajectory, raw=True)
        self._chambers = ChamberInput(
            self._setup, intake.measure, self._begin, self._reports.leave_out
        )
        if self._setup.law.can_stiffen:
            intake.subscribe(Float64, 'co_contraction_reference', self._take_co_contraction)
        self._states = StateTopic(self, term_names(len(self._setup.topics.muscles)))
        self._commands = commands_of(self, self._setup.topics)
        self._rig = RigWatch(self, 'joint_states', self._commands.publishers)

    # Time ----------------------------------------------------------------------------------

    @property
    def _tick_rate(self) -> float:
        return WATCH_RATE if self._is_followed else self._setup.settings.rate

    def start(self) -> None:
        """Start to count time: the creation of the node does not count as an interruption."""
        line = start_line.of_controller(
            self._setup,
            self._given.values,
            self.resolve_topic_name,
            has_sim_time=self._is_followed,
        )
        self.get_logger().info(line)
        super().start()
        self._intake.mark(steady_ns())

    def tick(self) -> None:
        """Send a command; if time follows the states, only check whether the states stop."""
        now = steady_ns()
        self._intake.look()
        self._prepare()
        if self._is_followed:
            self._watch()
            self._goals.update()
            self._intake.mark(now)
            return
        settings = self._setup.settings
        longest = max(min(0.5 * settings.state_timeout, LATE), 3.0 / settings.rate) * SECOND
        was_late = now - self._ticked > longest and not self._has_waited
        self._ticked, self._has_waited = now, was_late
        if not was_late:  # else messages that arrived meanwhile are received first
            self._step(now / SECOND, self.get_clock().now().nanoseconds)
            self._goals.update()
            self._intake.mark(now)

    def _restart_after_pause(self, pause: int) -> None:
        """Start again after *pause* ns without a command: load and pressure may have changed."""
        self._loop.forget()
        self._loop.pressures = None
        self._chambers.forget()
        self._stamp = None
        if self._loop.is_enabled:
            self._reports.restart(pause, self._setup.settings.interruption_limit)

    def _watch(self) -> None:
        if self._stamp is None:
            return
        if self._is_seen():
            self._begin()
        else:
            now = self.get_clock().now().nanoseconds
            self._step(now / SECOND, now)

    def _is_seen(self) -> bool:
        """Return whether the newest state is not older than the timeout."""
        age = steady_ns() - self._seen
        if self._is_followed and self._stamp is not None:
            # The smaller of two ages: /clock may arrive before the states that belong to it.
            age = min(age, self.get_clock().now().nanoseconds - self._stamp)
        return age <= self._setup.settings.state_timeout * SECOND

    def _prepare(self) -> None:
        """Determine the pressure at which control begins."""
        self._chambers.prepare(self._loop, self._stamp, self._setup, self._is_seen)

    def _begin(self) -> None:
        """If time follows the states, answer the state at which control has waited."""
        waits = self._loop.state in (WAITING, BLIND)
        if self._is_followed and waits and self._stamp is not None and self._is_seen():
            self._prepare()
            self._step(self._stamp / SECOND, self._stamp)

    def _step(self, time: float, stamp: int) -> None:
        """Send a command at *time* in s, by the clock of the loop; *stamp* is ROS time in ns."""
        loop, before = self._loop, self._loop.state
        # If time follows the states, so many commands are kept that they are confirmed too late.
        is_checked = loop.lost is not None and not self._is_followed
        if is_checked and steady_ns() - self._answered < VENT_PERIOD:
            return
        loop.is_received = not is_checked or self._rig.is_received()
        try:
            pressures = loop.tick(time)
        except ArithmeticError:
            pressures = (float('nan'),)
        self._tracking.record(loop)
        if pressures is None or self._intake.look():  # the process can be stopped here, too
            return
        if not all(map(isfinite, pressures)):
            loop.enable(False)  # the valve lowers the load after its timeout
            loop.pressures = None
            self._fault = 'the law gave a pressure that is not finite: disabled'
            self.get_logger().error(self._fault)
            return
        if loop.state == BLIND != before:
            self._look_for_states()
        if loop.lost is not None and self._rig.is_new(loop.lost):
            loop.leave()
            return
        self._publish(pressures)
        if self._intake.look():
            # It was stopped while it published: the rig may have received the old command only
            # now. A rig that has begun to vent must not follow it; a rig without a timeout has
            # kept this command anyway.
            timeout = self._setup.settings.command_timeout
            if timeout:
                self._publish(loop.vented(pressures, self._intake.pause / SECOND - timeout))
            return
        rate = self._setup.settings.state_rate
        # Slightly early counts as due, since the stamps of samples are rounded.
        is_due = bool(rate) and not 0 <= stamp - self._shown < 0.99 * SECOND / rate
        if loop.state == RUNNING and is_due:
            self._shown = stamp
            self._states.publish(stamp, loop.law.terms)

    def _publish(self, pressures: Pressures) -> None:
        self._commands.publish(pressures)
        self._answered = steady_ns()
        self._commanded += 1

    # Inputs --------------------------------------------------------------------------------

    def _see(self, message: JointState) -> None:
        settings = self._setup.settings
        try:
            state = measured_state(
                message, settings.joint_name, settings.velocity_source == 'measured'
            )
        except RangeError as error:
            self._blindness = str(error)
            self.get_logger().warning(self._blindness, throttle_duration_sec=1.0)
            return
        self._blindness = ''
        if state.stamp and state.stamp == self._stamp:
            self._repeated = steady_ns()
            self._see_again()
            return
        passed = 0 if self._stamp is None else state.stamp - self._stamp
        if not self._is_followed:
            now = steady_ns()
            late = self._lateness.of(state.stamp, now)
            self._stamp = state.stamp
            self._pass_on(state, now - late, late / SECOND)
            self._note_lateness(late / SECOND)
            return
        if passed < 0:
            self._loop.forget()  # simulated time starts again, and so does control
            self._chambers.forget()
        elif self._loop.state == RUNNING and passed > settings.longest_interruption * SECOND:
            self._restart_after_pause(passed)
        self._stamp = state.stamp
        self._pass_on(state, state.stamp)
        self._prepare()
        self._step(state.stamp / SECOND, state.stamp)
        self._goals.update()

    def _pass_on(self, state: MeasuredState, time: int, late: float = 0.0) -> None:
        """Give the loop a state of *time* in ns by its clock, unless the state cannot be true.

        It arrived *late* s late.
        """
        stamp = state.stamp / SECOND if state.stamp else None
        reading = Measurement(time / SECOND, state.position, state.velocity, stamp, late)
        fault = self._loop.see(reading)
        if not fault:
            # If this is the time of the loop, it must be the same for both: what is too old for
            # the loop is then too old for the reason, too.
            self._seen, self._last = steady_ns() if self._is_followed else time, reading
            return
        self._blindness = f'joint_states has a {fault}: not used'
        self._reports.leave_out(self._blindness)

    def _note_lateness(self, late: float) -> None:
        """Report that a state arrived *late* s late."""
        self._reports.delay(late)
        if late > self._setup.settings.state_timeout:
            self._blindness = control_health.late(late)

    def _see_again(self) -> None:
        """Answer a state that is published again: in lockstep the answer was not received."""
        last = self._loop.pressures
        is_due = steady_ns() - self._answered > REPEAT
        if self._is_followed and self._loop.state == RUNNING and last is not None and is_due:
            self._publish(last)

    def _take_reference(self, message: Float64) -> None:
        if self._is_ready('position_reference'):
            try:
                self._loop.source.set_target(message.data)
            except RangeError as error:
                self._reports.refuse(str(error))

    def _take_co_contraction(self, message: Float64) -> None:
        if self._is_ready('co_contraction_reference'):
            try:
                self._loop.law.stiffen(message.data)
            except RangeError as error:
                self._reports.refuse(str(error))

    def _take_trajectory(self, message: bytes) -> None:
        if not self._is_ready('joint_trajectory'):
            return
        try:
            begin, points = read_trajectory(message, self._setup.settings.joint_name)
            if points.count:
                self._play(begin, points)
            else:
                self._loop.source.stop()
        except RangeError as error:
            self._reports.refuse(str(error))

    def _play(self, begin: int, points: Points) -> tuple[ReferenceTrajectory, float]:
        """Follow *points* from the ROS time *begin* in ns, 0 for now; also return when, in s."""
        wait = self._wait_for(begin) if begin else 0.0
        return self._loop.source.play(points, wait), self._loop.time + wait

    def _follow(self, message: bytes) -> tuple[ReferenceTrajectory, float]:
        """Follow the trajectory of a goal, which must not be over already."""
        begin, points = read_trajectory(message, self._setup.settings.joint_name)
        points.refuse_bad()
        over = -self._wait_for(begin) - points.times[-1] if begin else 0.0
        if over > 0.0:
            raise RangeError(f'the trajectory ended {over:.4g} s ago')
        return self._play(begin, points)

    def _wait_for(self, begin: int) -> float:
        """Return the time in s from the last step of the loop to the ROS time *begin* in ns."""
        if self._is_followed and self._stamp is not None:
            return (begin - self._stamp) / SECOND
        since = steady_ns() / SECOND - self._loop.time
        return (begin - self.get_clock().now().nanoseconds) / SECOND + since

    def _is_ready(self, topic: str) -> bool:
        is_ready = self._loop.state == RUNNING
        if not is_ready:
            self._reports.refuse(f'{topic} is ignored: {self._trouble()}')
        return is_ready

    def _enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._loop.enable(request.data)
        if request.data:
            self._fault = ''
            if self._is_followed and self._last:
                self._loop.see(self._last)  # the simulator may wait for the answer to it
        else:
            self._loop.pressures = None  # another node may command from now on
        response.success = True
        response.message = self._trouble() or 'controlling'
        return response

    def _change(self, now: ControlSetup) -> None:
        """Continue with other parameters."""
        before, self._setup = self._setup, now
        loop, settings = self._loop, now.settings
        _protect(loop, now)
        loop.period = now.law.period
        if now.law.needs_new_law(before.law):
            law = now.law.make_law()
            warm_up(law, now.law.reach, loop.period)
            sentence = loop.change(law, now.law.make_reference_source())
            if sentence:
                self._reports.reject(sentence)
            loop.plausibility.bounds = bounds_of(law.allocation)
        else:
            now.law.take_over(loop.law, before.law)
            loop.source.set_shape(now.law.shape)
        if before.settings.rate != settings.rate:
            self.ticker.start(self._tick_rate, monotonic_ns())

    def finish(self) -> None:
        """Release the action and the samplers of the topics."""
        self._goals.close()
        self._topics.close()

    # Health --------------------------------------------------------------------------------

    def _trouble(self) -> str:
        """Return why the node does not control, '' if it does."""
        did = self._setup.settings.on_timeout
        return control_health.trouble(self._loop, did, self._unusable(), self._fault)

    def _unusable(self) -> str:
        """Return why the joint states that arrive are not usable, '' if they are.

        A stamp may repeat for a while: in lockstep a state is sent again until it is answered, and
        a rig that publishes faster than it measures repeats each state, also the one with which
        it stops.
        """
        lasts = self._repeated - self._seen > 0.5 * self._setup.settings.state_timeout * SECOND
        if self._blindness or self._stamp is None or not lasts or self._is_seen():
            return self._blindness
        return control_health.repeated(self._stamp)

    def _look_for_states(self) -> None:
        """Log once what control waits for, and once when it continues."""
        loop, now, why = self._loop, steady_ns() / SECOND, self._trouble()
        if loop.state in (WAITING, RUNNING):
            self._reports.wait(why, now)
        if loop.state in (BLIND, RUNNING):
            self._reports.miss(why, now, loop.timeout, loop.starts)

    def _control(self) -> Health:
        self._look_for_states()
        age = None if self._stamp is None else (steady_ns() - self._seen) / SECOND
        self._reports.follow(self._tracking.warning)
        received = self._reports.received(age, self._unusable())
        return control_health.control(self._loop, self._setup, received, self._fault)

    def _timing(self) -> Health:
        commanded, self._commanded = self._commanded, 0
        wanted = None if self._is_followed else self._setup.settings.rate
        return control_health.timing(self.ticker.report(monotonic_ns()), commanded, wanted)


def _protect(loop: Loop, setup: ControlSetup) -> None:
    """Give *loop* the settings for the case that joint states stop."""
    settings = setup.settings
    loop.timeout, loop.safe = settings.state_timeout, settings.on_timeout
    loop.vent_time = settings.vent_time
