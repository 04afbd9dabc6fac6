# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node of ``pam_sim``: the help of this program lists its topics and services."""

from collections.abc import Sequence
from time import monotonic_ns

from rclpy.time import Time
from std_srvs.srv import SetBool, Trigger

from pam_ros.health import simulator as sim_health
from pam_ros.health import start_line
from pam_ros.health.health import Health, Level
from pam_ros.health.onsets import Onsets
from pam_ros.health.simulator import RunProgress
from pam_ros.health.waits import Waits
from pam_ros.nodes.common.diagnostics import Diagnostics
from pam_ros.nodes.common.node_parameters import NodeParameters
from pam_ros.nodes.common.rclpy_internals import overrides_of
from pam_ros.nodes.common.spin import TickingNode
from pam_ros.nodes.common.topic_watch import TopicWatch
from pam_ros.nodes.sim.commands import subscribe_commands
from pam_ros.nodes.sim.contraction import ContractionReport
from pam_ros.nodes.sim.output import Output
from pam_ros.nodes.sim.topics import watched_topics
from pam_ros.processes.notice import notice
from pam_ros.settings.scene import Scene, SimulationSetup
from pam_ros.simulator.modes import Mode, mode_of
from pam_ros.simulator.plant import Plant
from pam_ros.simulator.simulator import Simulator

LONG = 2.0  # s: more than it takes to load kernels that are already compiled


class PamSim(TickingNode):
    """A rig simulated in the configured time mode; it takes commands and publishes its state."""

    def __init__(self) -> None:
        """Create the rig that the parameters describe, in its initial state."""
        super().__init__('pam_sim')
        scene = Scene(overrides_of(self))
        self._given = NodeParameters(self, scene.table(), scene.build, self._change)
        setup: SimulationSetup = self._given.built
        with notice(LONG, self._log_compiling):
            self._plant = plant = Plant(setup)
        self._output = Output(self, setup)
        publishers = subscribe_commands(self, setup, self._take)
        self._mode: Mode = mode_of(setup, publishers, self.get_clock())
        self._simulator = Simulator(plant, self._mode, self._output)
        self.ticker = self._simulator.ticker
        self.keeps_wall_time = not (self._mode.makes_time or self._mode.follows_clock)
        self._reported = self._bad = 0
        topic = self.resolve_topic_name(setup.command_topics[0])
        self._waits = Waits(self.get_logger(), plant, topic)
        self._onsets = Onsets(self.get_logger(), plant)
        self.create_service(Trigger, '~/reset', self._reset)
        self.create_service(SetBool, '~/pause', self._pause)
        self.create_service(Trigger, '~/step', self._step)
        self._topics = TopicWatch(self, watched_topics(setup))
        self._diagnostics = Diagnostics(
            self,
            {
                'timing': self._timing,
                'commands': self._commands,
                'contraction': ContractionReport(self, plant).health,
                'topics': self._topics.health,
            },
            (lambda: Time(nanoseconds=self._mode.now())) if self._mode.makes_time else None,
        )
        self._given.refuse_mistyped()

    def _log_compiling(self) -> None:
        self.get_logger().info(
            'this start takes longer: kernels that are not on disk are compiled first, which '
            'can take half a minute, once; python3 -m pam_ros.rig.warm compiles all of them'
        )

    def start(self) -> None:
        """Start simulated time now."""
        line = start_line.of_simulator(
            self._plant.setup,
            self._given.values,
            self.resolve_topic_name,
            has_sim_time=self._mode.follows_clock,
        )
        self.get_logger().info(line)
        super().start()
        self._simulator.start()

    def tick(self) -> None:
        """Simulate and publish all samples that are due."""
        self._simulator.tick()

    def finish(self) -> None:
        """Release the samplers of the topics."""
        self._topics.close()

    # Inputs --------------------------------------------------------------------------------

    def _take(self, pressures: Sequence[float], muscles: Sequence[int]) -> None:
        bad = self._simulator.take(pressures, muscles)
        if bad is None:
            return
        self._bad = bad.muscle
        if bad.is_refused:  # each kind of warning has its own limit of rate
            self.get_logger().warning(bad.reason, throttle_duration_sec=1.0)
        else:
            self.get_logger().warning(bad.reason, throttle_duration_sec=1.0)

    def _change(self, now: SimulationSetup) -> None:
        """Continue with other parameters."""
        self._simulator.change(now)
        self._output.describe(now)

    def _reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._simulator.reset()
        response.success, response.message = True, 'at the initial state'
        return response

    def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._simulator.pause(request.data)
        response.success, response.message = True, 'paused' if request.data else 'running'
        return response

    def _step(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Simulate ``step_periods`` periods with the present commands, and publish each."""

        def is_stopped() -> bool:
            self.has_answered_at_end = self.stop.is_made
            return self.stop.is_made

        response.success, response.message = self._simulator.step(is_stopped)
        return response

    # Health --------------------------------------------------------------------------------

    def _timing(self) -> Health:
        simulator, mode = self._simulator, self._mode
        kept = self.ticker.report(monotonic_ns())
        published, self._reported = simulator.published - self._reported, simulator.published
        done = RunProgress(
            published,
            mode.speed,
            self._plant.time,
            mode.lost,
            mode.jumps,
            is_paused=simulator.is_paused,
            follows_clock=mode.follows_clock,
            has_clock=not mode.follows_clock or mode.now() > 0,
            waits=mode.turns.complaint if mode.turns is not None else '',
            fault=simulator.fault,
        )
        self._onsets.look()
        if not simulator.is_paused:
            missing = '' if done.has_clock else sim_health.NO_CLOCK
            self._waits.look(missing if mode.follows_clock else None, done.waits)
        return sim_health.timing(self._plant.setup.settings, kept, done, self.scheduling)

    def _commands(self) -> Health:
        health = sim_health.commands(self._plant, self._bad)
        stopped = health.level is Level.WARN and any(self._plant.has_timed_out)
        self._waits.look_for_commands(health.message if stopped else '')
        return health
