# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node of ``pam_sim``: the help of this program lists its topics and services."""

import math
from time import monotonic_ns

from rclpy.time import Time
from std_msgs.msg import Float64, Float64MultiArray
from std_srvs.srv import SetBool, Trigger

from pam_ros.health import simulator as sim_health
from pam_ros.health import start_line
from pam_ros.health.health import Health, Level
from pam_ros.health.onsets import Onsets
from pam_ros.health.simulator import Progress
from pam_ros.health.waits import Waits
from pam_ros.nodes.common.diagnostics import Diagnostics
from pam_ros.nodes.common.node_parameters import NodeParameters, given
from pam_ros.nodes.common.spin import TickingNode
from pam_ros.nodes.common.topic_watch import TopicWatch
from pam_ros.nodes.sim.commands import subscribe_commands
from pam_ros.nodes.sim.contraction import ContractionReport
from pam_ros.nodes.sim.lockstep import Turns
from pam_ros.nodes.sim.output import Output
from pam_ros.nodes.sim.sim_time import FollowedTime, OwnTime
from pam_ros.nodes.sim.topics import watched_topics
from pam_ros.processes.notice import notice
from pam_ros.settings.scene import Scene, SimulationSetup
from pam_ros.simulator.plant import BadCommand, OneReading, Plant, Reading
from pam_ros.timing.grid import Grid
from pam_ros.timing.interruption import Interruptions, steady_ns
from pam_ros.timing.pace import CATCH_UP, SECOND
from pam_ros.timing.ticker import Ticker

SLICE = 5_000_000  # ns of simulation after which commands and services are handled
GAP = 200_000  # ns for them when simulated time passes as fast as possible
IDLE_RATE = 10.0  # Hz at which a simulator whose time stands still publishes its state
FASTEST_TICK = 1000.0  # Hz
LONG = 2.0  # s: more than it takes to load kernels that are already compiled


class PamSim(TickingNode):
    """A rig simulated in the configured time mode; it takes commands and publishes its state."""

    def __init__(self) -> None:
        """Create the rig that the parameters describe, in its initial state."""
        super().__init__('pam_sim')
        scene = Scene(given(self))
        self._given = NodeParameters(self, scene.table(), scene.build, self._change)
        self._setup = self._given.built
        settings = self._setup.settings
        with notice(LONG, self._log_compiling):
            self._plant = Plant(self._setup)
        self._is_lockstep = settings.time_mode == 'lockstep'
        self._is_followed = not settings.has_own_time
        self._time: FollowedTime | OwnTime
        if self._is_followed:
            self._time = FollowedTime(settings.physics_rate, self.get_clock())
        else:
            self._time = OwnTime(settings.physics_rate, self._factor)
        self.keeps_wall_time = self._is_followed and not self._time.follows_clock
        self._is_paused = False
        self._published = self._bad = 0
        self._last: tuple[int, Reading | OneReading] | None = None
        self._interruptions = Interruptions(steady_ns())
        self._samples = Grid(settings.physics_rate)
        self._clock_ticks = Grid(settings.physics_rate)
        self._one = self._setup.is_one
        self._output = Output(self, self._setup)
        self._turns = Turns(self, len(self._setup.muscles))
        subscribe_commands(self, self._setup, self._turns, self._command, self._command_all)
        self._begin()
        topic = self.resolve_topic_name('pressure_command' if self._one else 'pressure_commands')
        self._waits = Waits(self.get_logger(), self._plant, topic)
        self._onsets = Onsets(self.get_logger(), self._plant)
        self.create_service(Trigger, '~/reset', self._reset)
        self.create_service(SetBool, '~/pause', self._pause)
        self.create_service(Trigger, '~/step', self._step)
        self._topics = TopicWatch(self, watched_topics(self._setup))
        self._diagnostics = Diagnostics(
            self,
            {
                'timing': self._timing,
                'commands': self._commands,
                'contraction': ContractionReport(self, self._plant).health,
                'topics': self._topics.health,
            },
            None if self._is_followed else lambda: Time(nanoseconds=self._time.now()),
        )
        self._given.refuse_mistyped()
        self.ticker = Ticker(self._tick_rate)

    def _log_compiling(self) -> None:
        self.get_logger().info(
            'this start takes longer: kernels that are not on disk are compiled first, which '
            'can take half a minute, once; python3 -m pam_ros.rig.warm compiles all of them'
        )

    def start(self) -> None:
        """Start simulated time now."""
        line = start_line.of_simulator(
            self._setup,
            self._given.values,
            self.resolve_topic_name,
            has_sim_time=self._time.follows_clock,
        )
        self.get_logger().info(line)
        super().start()
        self._interruptions.mark(steady_ns())
        self._time.align(0)
        self._begin()
        if self._is_lockstep:
            self._run_to(0)

    def _begin_again(self) -> None:
        """Set the initial state again; the simulator's own time continues one period later."""
        self._time.restart(self._plant.step, round(SECOND / self._setup.settings.publish_rate))
        self._begin()

    def _begin(self) -> None:
        """Set the initial state."""
        self._plant.begin()
        self._fault = ''
        self._samples.begin(self._setup.settings.publish_rate)
        self._clock_ticks.begin(self._clock_rate)
        self._clock_step = -1  # the last one whose time was published on /clock
        self._turns.begin()

    # Time ----------------------------------------------------------------------------------

    @property
    def _factor(self) -> float:
        """The desired speed of simulated time; 0 in lockstep, where commands set the pace."""
        return 0.0 if self._is_lockstep else self._setup.settings.speed_factor

    @property
    def _clock_rate(self) -> float:
        return 0.0 if self._is_followed else self._setup.settings.clock_rate

    @property
    def _tick_rate(self) -> float:
        settings = self._setup.settings
        if self._is_followed:
            return settings.publish_rate
        if self._is_lockstep or self._is_paused:
            return IDLE_RATE
        rate = max(settings.publish_rate, settings.clock_rate) * self._factor
        return min(rate, FASTEST_TICK) if rate else FASTEST_TICK

    def tick(self) -> None:
        """Simulate and publish all samples that are due; if time stops, repeat the last state."""
        self._look_for_stop()
        self._interruptions.mark(steady_ns())
        if self._is_paused:
            self._publish_again()
        elif self._is_lockstep:
            if self._turns.is_complete:
                self._run_period()
            elif self._turns.must_repeat():
                self._publish_again()
        else:
            self._run_to_now()
            if not self._time.follows_clock:
                # Wake up when the next sample is due; resets and jumps of ROS time move it.
                next_one = self._time.steady_time(min(self._samples.next, self._clock_ticks.next))
                self.ticker.aim(next_one if self._time_is_paced else monotonic_ns() + GAP)

    @property
    def _time_is_paced(self) -> bool:
        return self._is_followed or self._factor > 0.0

    def _publish_again(self) -> None:
        """Publish the present state again.

        If the simulator makes its own time, the last reading is repeated. The sensors are not read
        again, so that their noise does not depend on the length of the pause.
        """
        if self._is_followed:
            self._publish_at(self._time.now())
        elif self._last:
            self._output.publish_clock(self._time.now())
            self._publish_reading(*self._last)

    def _run_to_now(self, ahead: float = 0.0) -> None:
        """Simulate the steps that are due within *ahead* steps, and publish each sample."""
        if not (self._is_paused or self._is_lockstep):
            self._run_to(self._time.due(self._plant.step, ahead), monotonic_ns() + SLICE)

    def _run_to_command(self) -> None:
        """Simulate up to the step that is nearest to the arrival of a command.

        The command acts from this step on: at most half a step early or late, on average neither.
        """
        if self._time_is_paced:
            self._run_to_now(ahead=0.5)

    def _run_to(self, due: int, end: float = math.inf) -> None:
        """Simulate to the step *due*, or to the first sample after the steady time *end* in ns."""
        plant, samples, clock = self._plant, self._samples, self._clock_ticks
        # ROS time is followed without an interruption: the number of due steps is bounded.
        end = math.inf if self._is_followed else end
        try:
            while (step := min(samples.next, clock.next)) <= due:
                plant.advance(step)
                if step == clock.next:
                    self._output.publish_clock(self._time.stamp(step))
                    self._clock_step = step
                    clock.advance()
                if step == samples.next:
                    self._publish(self._time.stamp(step))
                    samples.advance()
                    self._turns.begin()
                if end < math.inf and monotonic_ns() > end:
                    return
            plant.advance(due)
        except (ArithmeticError, ValueError) as error:  # errors of the kernel as plain Python
            self._stop_at_fault(error)

    def _run_period(self) -> None:
        """In lockstep, simulate to the next state: all muscles were commanded.

        If the last time on ``/clock`` is that of the state that was answered, it is published
        again. This shows a recorder until when time stood still, and that the command was sent
        before it.
        """
        if self._clock_step == self._plant.step:
            self._output.publish_clock(self._time.now())
        self._run_to(self._samples.next)

    def _sample_from_here(self) -> None:
        """Let the next sample be due one period from now."""
        self._samples.begin(self._setup.settings.publish_rate, self._plant.step, 1)

    # Outputs -------------------------------------------------------------------------------

    def _publish(self, stamp: int) -> None:
        self._last = stamp, self._plant.read_one() if self._one else self._plant.read()
        self._publish_reading(*self._last)

    def _publish_at(self, stamp: int) -> None:
        """Publish while time stands still; pause if new parameters made the state invalid."""
        try:
            self._publish(stamp)
        except ArithmeticError as error:
            self._stop_at_fault(error)

    def _publish_reading(self, stamp: int, reading: Reading | OneReading) -> None:
        self._output.publish(stamp, reading)
        self._published += 1

    def _stop_at_fault(self, error: Exception) -> None:
        """Reset and pause, because the state of the model is no longer valid."""
        time = self._plant.time
        self._begin_again()
        self._set_paused(True)
        self._fault = (
            f'the state is invalid {time:.3f} s after the start, {error}: reset and paused'
        )
        self.get_logger().error(self._fault)

    # Inputs --------------------------------------------------------------------------------

    def _look_for_stop(self) -> bool:
        """Return whether commands that arrive now may have been sent while this node was stopped.

        They belong to a time that is never simulated, and a controller without joint states may
        have sent them to vent. They are ignored: the last command before them remains active.
        """
        longest = max(CATCH_UP, round(3 * SECOND / self._tick_rate))
        self._interruptions.find(steady_ns(), longest)
        return self._is_followed and not self._is_paused and self._interruptions.is_settling

    def _command(self, muscle: int, message: Float64) -> None:
        if self._look_for_stop():
            return
        self._run_to_command()
        self._complain(self._plant.take(muscle, message.data))
        self._answer(muscle)

    def _command_all(self, message: Float64MultiArray) -> None:
        if self._look_for_stop():
            return
        wanted, count = len(self._setup.muscles), len(message.data)
        if count != wanted:
            reason = f'pressure_commands has {count} values for {wanted} muscles: not used'
            self.get_logger().warning(reason, throttle_duration_sec=1.0)
            return
        self._run_to_command()
        self._complain(self._plant.take_all(message.data.tolist()))
        self._answer(None)

    def _complain(self, bad: BadCommand | None) -> None:
        if bad is None:
            return
        self._bad = bad.muscle
        if bad.is_refused:  # each kind of warning has its own limit of rate
            self.get_logger().warning(bad.reason, throttle_duration_sec=1.0)
        else:
            self.get_logger().warning(bad.reason, throttle_duration_sec=1.0)

    def _answer(self, muscle: int | None) -> None:
        """In lockstep, simulate a period when all muscles were commanded."""
        if self._is_lockstep:
            self._turns.take(muscle)
            if self._turns.is_complete and not self._is_paused:
                self._run_period()

    def _change(self, now: SimulationSetup) -> None:
        """Continue with other parameters."""
        self._run_to_now()
        before, self._setup = self._setup.settings, now
        self._plant.change(now)
        self._output.describe(now)
        settings = now.settings
        if isinstance(self._time, OwnTime) and self._time.factor != self._factor:
            self._time.factor = self._factor
            self._time.align(self._plant.step)
        if settings.publish_rate != before.publish_rate:
            self._sample_from_here()
        if settings.clock_rate != before.clock_rate:
            passed = math.floor(self._plant.time * settings.clock_rate + 1e-9)
            self._clock_ticks.begin(self._clock_rate, sample=passed + 1)
        if self._tick_rate != self.ticker.rate:
            self.ticker.start(self._tick_rate, monotonic_ns())
        self._interruptions.mark(steady_ns())  # compiling takes time: the process was not stopped

    def _reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._begin_again()
        self._turns.settle()
        if self._is_lockstep or self._is_paused:
            self._run_to(0)
        response.success, response.message = True, 'at the initial state'
        return response

    def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        if self._time_is_paced:
            self._run_to_now()
        if self._is_paused and not request.data:
            self._time.align(self._plant.step)
            self._turns.settle()
            self._fault = ''
        if request.data and not (self._is_paused or self._is_followed or self._is_lockstep):
            self._publish_at(self._time.stamp(self._plant.step))  # to be repeated
        self._set_paused(request.data)
        response.success, response.message = True, 'paused' if request.data else 'running'
        return response

    def _set_paused(self, is_paused: bool) -> None:
        if is_paused != self._is_paused:
            self._is_paused = is_paused
            self.ticker.start(self._tick_rate, monotonic_ns())

    def _step(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Simulate ``step_periods`` periods with the present commands, and publish each."""
        if not self._is_paused:
            response.message = 'simulated time is not paused: pause it first'
            return response
        response.success, response.message = self._step_periods()
        self._interruptions.mark(steady_ns())  # it was busy, not stopped
        return response

    def _step_periods(self) -> tuple[bool, str]:
        """Simulate the periods of a step; return whether all are done, and the response's text."""
        periods = self._setup.settings.step_periods
        self._sample_from_here()
        for done in range(periods):
            if self.stop.is_made:
                self.has_answered_at_end = True
                return False, f'stop requested: simulated {done} of {periods} periods'
            if self._is_followed:
                # The stamp of each sample is the time at which it is published.
                self._time.align(self._samples.next)
            self._run_to(self._samples.next)
            if self._fault:
                return False, self._fault
        return True, f'simulated {periods} periods, until {self._plant.time:.9g} s'

    def finish(self) -> None:
        """Release the samplers of the topics."""
        self._topics.close()

    # Health --------------------------------------------------------------------------------

    def _timing(self) -> Health:
        time, kept = self._time, self.ticker.report(monotonic_ns())
        published, self._published = self._published, 0
        done = Progress(
            published,
            1.0 if self._is_followed else self._factor,
            self._plant.time,
            time.lost,
            time.jumps,
            is_paused=self._is_paused,
            follows_clock=time.follows_clock,
            has_clock=not time.follows_clock or time.now() > 0,
            waits=self._turns.complaint if self._is_lockstep else '',
            fault=self._fault,
        )
        self._onsets.look()
        if not self._is_paused:
            self._waits.look('' if done.has_clock else sim_health.NO_CLOCK, done.waits)
        return sim_health.timing(self._setup.settings, kept, done, self.scheduling)

    def _commands(self) -> Health:
        health = sim_health.commands(self._plant, self._bad)
        self._waits.look_for_commands(health.message if health.level is Level.WARN else '')
        return health
