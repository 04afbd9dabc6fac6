# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node of ``pam_control``: the help of this program lists its topics and services."""

from math import isfinite
from time import monotonic_ns

from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool

from pam_ros.control.loop import BLIND, RUNNING, WAITING, Loop, Measurement
from pam_ros.control.signals import Pressures, term_names
from pam_ros.errors import RangeError
from pam_ros.health import start_line
from pam_ros.health.learned import learning
from pam_ros.health.loop_health import LoopHealth
from pam_ros.health.reports import Reports
from pam_ros.nodes.common.commands import commands_of
from pam_ros.nodes.common.diagnostics import Diagnostics
from pam_ros.nodes.common.node_parameters import NodeParameters
from pam_ros.nodes.common.rclpy_internals import overrides_of
from pam_ros.nodes.common.spin import TickingNode
from pam_ros.nodes.control.chamber_input import ChamberInput
from pam_ros.nodes.control.follow import Follow
from pam_ros.nodes.control.inputs import MeasuredState, measured_state
from pam_ros.nodes.control.intake import StateIntake
from pam_ros.nodes.control.references import ReferenceInput
from pam_ros.nodes.control.rig_watch import RigWatch
from pam_ros.nodes.control.state import StateTopic
from pam_ros.nodes.control.topics import watch_topics
from pam_ros.settings.control import ControlSetup, settings_of
from pam_ros.timing.interruption import steady_ns
from pam_ros.timing.loop_pacing import Arrival, Step, loop_pacing
from pam_ros.timing.pace import SECOND
from pam_ros.timing.pacing import Reply
from pam_ros.timing.ticker import Ticker

# ns between commands that vent. A rig that is discovered between the check for a new one and the
# command receives the command: the fewer commands, the less likely. It is a little less than
# 10 ms, so that jitter leaves out no command at a rate of 100 Hz.
VENT_PERIOD = 9 * SECOND // 1000


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
        self._pacing = loop_pacing(
            self._setup.settings,
            lambda: self.get_clock().now().nanoseconds,
            is_simulated=bool(self.get_parameter('use_sim_time').value),
        )
        self.keeps_wall_time = self._pacing.keeps_wall_time
        self._last: Measurement | None = None  # the newest usable one
        self._reports = Reports(self.get_logger())
        self._health = LoopHealth(self._loop, self._current, self._pacing, self._reports)
        self._references = ReferenceInput(
            self._loop, self._current, self._pacing, self._health, self._reports
        )
        self._intake = StateIntake(self, self._pacing, self._restart_after_interruption)
        self._open_topics()
        self.create_service(SetBool, '~/enable', self._enable)
        self._topics = watch_topics(self, self._setup, self._loop)
        parts = {
            'timing': lambda: self._health.timing(self.ticker.report(monotonic_ns())),
            'control': self._health.control,
            'learning': lambda: learning(self._loop.law.learned, self._setup.law.unit),
            'topics': self._topics.health,
        }
        self._diagnostics = Diagnostics(self, parts)
        self._goals = Follow(
            self,
            self._loop,
            self._current,
            self._references.play_goal,
            self._health.trouble,
            self._reports.reject,
        )
        self._given.refuse_mistyped()
        self.ticker = Ticker(self._pacing.tick_rate)

    def _current(self) -> ControlSetup:
        return self._setup

    def _make_loop(self) -> Loop:
        loop = self._setup.law.make_loop()
        _protect(loop, self._setup)
        loop.enable(self._setup.settings.start_enabled)
        return loop

    def _open_topics(self) -> None:
        self._intake.measure(JointState, 'joint_states', self._see)
        self._references.subscribe(self._intake)
        self._chambers = ChamberInput(
            self._setup, self._intake.measure, self._begin, self._reports.leave_out
        )
        self._states = StateTopic(self, term_names(len(self._setup.topics.muscles)))
        self._commands = commands_of(self, self._setup.topics)
        self._rig = RigWatch(self, 'joint_states', self._commands.publishers)

    # Time ----------------------------------------------------------------------------------

    def start(self) -> None:
        """Start to count time: the creation of the node does not count as an interruption."""
        line = start_line.of_controller(
            self._setup,
            self._given.values,
            self.resolve_topic_name,
            has_sim_time=self._pacing.answers_states,
        )
        self.get_logger().info(line)
        super().start()
        self._intake.mark(steady_ns())

    def tick(self) -> None:
        """Send a command; if time follows the states, only check whether the states stop."""
        now = steady_ns()
        self._intake.look()
        self._prepare()
        if self._pacing.receives_first(now):
            return
        step = self._pacing.due(now, is_waiting=self._is_waiting)
        if step is not None:
            self._step(step)
        self._goals.update()
        self._intake.mark(now)

    def _restart_after_interruption(self, pause: int) -> None:
        """Start again after an interruption of *pause* ns: the known state is too old."""
        self._pacing.forget()
        self._restart_after_pause(pause)

    def _restart_after_pause(self, pause: int) -> None:
        """Start again after *pause* ns without a command: load and pressure may have changed."""
        self._loop.forget()
        self._loop.pressures = None
        self._chambers.forget()
        if self._loop.is_enabled:
            self._reports.restart(pause, self._setup.settings.interruption_limit)

    @property
    def _is_waiting(self) -> bool:
        return self._loop.state in (WAITING, BLIND)

    def _prepare(self) -> None:
        """Determine the pressure at which control begins."""
        self._chambers.prepare(self._loop, self._pacing.stamp, self._setup, self._pacing.is_fresh)

    def _begin(self) -> None:
        """If time follows the states, answer the state at which control has waited."""
        if self._is_waiting and self._pacing.is_fresh():
            self._answer()

    def _answer(self) -> None:
        """Answer the newest state, if states are answered."""
        step = self._pacing.answer()
        if step is not None:
            self._prepare()
            self._step(step)

    def _step(self, step: Step) -> None:
        """Let the loop compute the command of a step, and send it."""
        loop, before = self._loop, self._loop.state
        is_checked = loop.lost is not None and self._pacing.confirms_commands
        if is_checked and self._pacing.since_command < VENT_PERIOD:
            return
        loop.is_received = not is_checked or self._rig.is_received()
        try:
            pressures = loop.tick(step.time)
        except ArithmeticError:
            pressures = (float('nan'),)
        self._health.record_step()
        if pressures is None or self._intake.look():  # the process can be stopped here, too
            return
        if not all(map(isfinite, pressures)):
            loop.enable(False)  # the valve lowers the load after its timeout
            loop.pressures = None
            self._health.fault = 'the law gave a pressure that is not finite: disabled'
            self.get_logger().error(self._health.fault)
            return
        if loop.state == BLIND != before:
            self._health.log_missing_states()
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
        if loop.state == RUNNING:
            self._states.publish(step.stamp, loop.law.terms, self._setup.settings.state_rate)

    def _publish(self, pressures: Pressures) -> None:
        self._commands.publish(pressures)
        self._pacing.note_command()
        self._health.count_command()

    # Inputs --------------------------------------------------------------------------------

    def _see(self, message: JointState) -> None:
        settings = self._setup.settings
        try:
            state = measured_state(
                message, settings.joint_name, settings.velocity_source == 'measured'
            )
        except RangeError as error:
            self._health.blindness = str(error)
            self.get_logger().warning(self._health.blindness, throttle_duration_sec=1.0)
            return
        self._health.blindness = ''
        arrival = self._pacing.arrive(state.stamp)
        if not arrival.is_repeated:
            self._take(state, arrival)
        if arrival.reply is Reply.COMMAND:
            self._answer()
            self._goals.update()
        elif arrival.reply is Reply.LAST_COMMAND:
            self._answer_again()

    def _take(self, state: MeasuredState, arrival: Arrival) -> None:
        """Give the loop a new state; start again if its time shows that this is necessary."""
        if arrival.is_earlier:
            self._loop.forget()  # simulated time starts again, and so does control
            self._chambers.forget()
        elif arrival.pause and self._loop.state == RUNNING:
            self._restart_after_pause(arrival.pause)
        stamp, late = state.stamp / SECOND if state.stamp else None, arrival.late / SECOND
        time = arrival.time / SECOND
        reading = Measurement(time, state.position, state.velocity, stamp, late)
        fault = self._loop.see(reading)
        if fault:
            self._health.blindness = f'joint_states has a {fault}: not used'
            self._reports.leave_out(self._health.blindness)
        else:
            self._pacing.use(arrival)
            self._last = reading
        self._health.note_lateness(late)

    def _answer_again(self) -> None:
        """Send the last command again."""
        last = self._loop.pressures
        if self._loop.state == RUNNING and last is not None:
            self._publish(last)

    def _enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._loop.enable(request.data)
        if request.data:
            self._health.fault = ''
            if self._pacing.answers_states and self._last:
                self._loop.see(self._last)  # the simulator may wait for the answer to it
        else:
            self._loop.pressures = None  # another node may command from now on
        response.success = True
        response.message = self._health.trouble() or 'controlling'
        return response

    def _change(self, now: ControlSetup) -> None:
        """Continue with other parameters."""
        before, self._setup = self._setup, now
        self._pacing.change(now.settings)
        _protect(self._loop, now)
        sentence = now.law.change_loop(self._loop, before.law)
        if sentence:
            self._reports.reject(sentence)
        if before.settings.rate != now.settings.rate:
            self.ticker.start(self._pacing.tick_rate, monotonic_ns())

    def finish(self) -> None:
        """Release the action and the samplers of the topics."""
        self._goals.close()
        self._topics.close()


def _protect(loop: Loop, setup: ControlSetup) -> None:
    """Give *loop* the settings for the case that joint states stop."""
    settings = setup.settings
    loop.timeout, loop.safe = settings.state_timeout, settings.on_timeout
    loop.vent_time = settings.vent_time
