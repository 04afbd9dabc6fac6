# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated rig that publishes a reference, and records what a controller makes of it."""

from collections.abc import Sequence
from time import monotonic, monotonic_ns, perf_counter

import numpy as np
from rclpy.context import Context
from rclpy.node import Node
from std_msgs.msg import Float64

from pam_ros.bench.faults import draw
from pam_ros.bench.forces import forces_of, left_alone
from pam_ros.bench.remote_plant import RemotePlant
from pam_ros.bench.scenario import Scenario
from pam_ros.bench.trial import Trial
from pam_ros.nodes.sim.commands import subscribe_commands
from pam_ros.nodes.sim.output import Output
from pam_ros.simulator.modes import mode_of
from pam_ros.simulator.plant import PlantReading
from pam_ros.simulator.simulator import Simulator
from pam_ros.timing.pace import SECOND

REFERENCE_PERIOD = 0.01  # s between messages of the reference


class BenchRig(Node):
    """The rig of a scenario, as ``pam_sim`` simulates it, which counts and records.

    It publishes ``position_reference`` 100 times per simulated second, each time before the state
    to which it belongs, so that a controller in lockstep receives the reference first.

    A state that is lost, or that is due during an outage, is recorded but not sent. In lockstep no
    command is awaited then. Simulated time continues at once after lost states, and in real time
    during an outage, so that a controller can notice that states stay away.
    """

    def __init__(self, scenario: Scenario, seed: int, time_mode: str, context: Context) -> None:
        """Create the rig at rest, with the *seed* of its sensors."""
        super().__init__('pam_sim', context=context)
        self._setups = scenario.setups(seed, time_mode)
        (_, setup), *self._changes = self._setups
        self._changes_at = [time for time, _ in self._changes]
        self.setup, self._scenario = setup, scenario
        rate = setup.settings.publish_rate
        self._count = round(scenario.duration * rate)
        self._draws = draw(scenario.messages, rate, self._count, seed)
        self._plant = RemotePlant(setup, self._draws, scenario.outages)
        self._output = Output(self, setup)
        self.publishers_of_commands = subscribe_commands(self, setup, self._take)
        mode = mode_of(setup, self.publishers_of_commands, self.get_clock())
        self._turns, self.is_lockstep = mode.turns, mode.turns is not None
        self._simulator = Simulator(self._plant, mode, self)
        self.ticker = self._simulator.ticker
        self._reference = self.create_publisher(Float64, 'position_reference', 10)
        self._origin = float(self._plant.position[0])
        times = np.arange(self._count) / rate
        self._demanded = self._origin + scenario.reference.at(times)
        self._stride = max(round(REFERENCE_PERIOD * rate), 1)
        muscles = len(setup.muscles)
        self._times = times
        self._position = np.zeros(self._count)
        self._pressure = np.full((self._count, muscles), np.nan)
        self._answer = np.full(self._count, np.nan)
        self._last = np.array(setup.pressures)  # Pa, the last commands as they were sent
        self.published = 0  # states of different times, with those that were not sent
        self.sent = 0  # of these, those that were sent
        self._is_sent = True  # whether the newest state was
        self._was_out = False  # whether the rig was out at the state before
        self._step = -1
        self._sent = perf_counter()
        self.commands = 0  # received
        self.not_finite_at: float | None = None  # simulated time in s of the first such command
        self._asked_at: float | None = None  # monotonic time in s of a state without an answer
        self._outage_at = 0, 0.0  # steady time in ns and simulated time in s of its first state
        self.is_waiting = True  # simulated time stands still, until the controller is known
        self._held: tuple[Sequence[float], Sequence[int]] = ((), ())

    @property
    def is_done(self) -> bool:
        """Whether the scenario is over."""
        return self.published > self._count

    @property
    def time(self) -> float:
        """The simulated time in s."""
        return self._plant.time

    @property
    def most_publishers(self) -> int:
        """How many publishers of commands a controller may have: one for each topic of them."""
        return max(1, len(self.setup.command_topics) - 1)

    @property
    def fault(self) -> str:
        """A sentence if the state of the rig became invalid, '' otherwise."""
        return self._simulator.fault

    @property
    def is_out(self) -> bool:
        """Whether the rig neither sends states nor takes commands at present."""
        return self._plant.is_out

    @property
    def waited(self) -> float:
        """The wall time in s for which a state has been without an answer, 0 if none is."""
        if self.is_out or self._asked_at is None:
            return 0.0
        return monotonic() - self._asked_at

    def start(self) -> None:
        """Publish the first state; time stands still until :meth:`go_on`."""
        self._simulator.start()
        if not self.is_lockstep:
            self._simulator.pause(True)

    def go_on(self) -> None:
        """Let simulated time pass: the controller is known, and its first command acts."""
        self.is_waiting = False
        if not self.is_lockstep:
            self._simulator.pause(False)
        # A controller may take references only once it controls.
        self._publish_reference(0)
        self._simulator.take(*self._held)

    def tick(self) -> None:
        """Simulate what is due, or publish a state again for which no command has arrived."""
        if not (self.is_lockstep or self.is_waiting):
            self._change_when_due()
        if self._is_sent or not self.is_lockstep:
            self._simulator.tick()
        self._skip()

    def _skip(self) -> None:
        """In lockstep, simulate the periods whose states are not sent."""
        if self._turns is None:
            return
        while not (self._is_sent or self.is_done):
            if self.is_out and (due := self._due_in_outage()) > monotonic_ns():
                self.ticker.aim(due)
                return
            before = self.published
            self._change_when_due()
            self._turns.take(range(self._last.size))
            self._simulator.take((), ())
            if self.published == before:
                return  # commands that were sent together are still collected

    def _due_in_outage(self) -> int:
        """Return the steady time in ns at which the next state of an outage is due."""
        begin, time = self._outage_at
        return begin + round((self.time - time + 1.0 / self.setup.settings.publish_rate) * SECOND)

    def trial(self) -> Trial:
        """Return what was recorded of a run that is done."""
        forces = forces_of(self._setups, self._scenario.duration)
        return Trial(
            self._times,
            self._position,
            self._demanded,
            self._pressure,
            np.array(self.setup.limits),
            self._answer,
            np.array(self._changes_at),
            self.setup.joints[0].is_revolute,
            np.array([(one.time, one.end) for one in self._scenario.outages]).reshape(-1, 2),
            np.array(forces).reshape(-1, 4),
            left_alone(self._setups, self._count) if forces else np.empty(0),
        )

    # What the simulator publishes -----------------------------------------------------------

    def publish_clock(self, stamp: int) -> None:
        """Publish the simulated time *stamp* in ns."""
        self._output.publish_clock(stamp)

    def publish(self, stamp: int, reading: PlantReading) -> None:
        """Publish a state of the plant unless it is lost, and record it the first time."""
        is_new = self._plant.step != self._step
        if is_new:
            self._step = self._plant.step
            self._record()
        k = min(self.published, self._count) - 1
        if k % self._stride == 0:
            self._publish_reference(k)
        if is_new:
            self._note(is_sent=not (self.is_out or self._draws.states_lost[k]))
        if self._is_sent:
            self._sent = perf_counter()
            self._output.publish(stamp, reading)

    def _note(self, *, is_sent: bool) -> None:
        """Note whether the newest state is sent."""
        if self.is_out and not self._was_out:
            self._outage_at = monotonic_ns(), self.time
        if self._was_out and not self.is_out and self._turns is not None:
            # A controller may have sent commands by its own clock: these are no answers.
            self._turns.settle()
        self._was_out, self._is_sent = self.is_out, is_sent
        if is_sent:
            self.sent += 1
            self._asked_at = self._asked_at or monotonic()
        elif self.is_out:
            self._asked_at = None

    def _publish_reference(self, k: int) -> None:
        self._reference.publish(Float64(data=float(self._demanded[k])))

    @property
    def is_heard(self) -> bool:
        """Whether a controller receives the reference and, in lockstep, simulated time."""
        has_clock = not self.is_lockstep or self.count_subscribers('/clock') > 0
        return has_clock and self._reference.get_subscription_count() > 0

    def _record(self) -> None:
        """Note the present state, and the command that acted until now."""
        if 0 < self.published <= self._count:
            self._pressure[self.published - 1] = self._last
        if self.published < self._count:
            self._position[self.published] = self._plant.position[0]
        self.published += 1

    def report(self, fault: str) -> None:
        """Log a fault of the simulation."""
        self.get_logger().error(fault)

    # What a controller sends ------------------------------------------------------------------

    def _take(self, pressures: Sequence[float], muscles: Sequence[int]) -> None:
        now = perf_counter()
        self.commands += 1
        self._asked_at = None
        if self.not_finite_at is None and not np.isfinite(pressures).all():
            self.not_finite_at = self._plant.time
        if self.is_done:
            return
        self._last[list(muscles)] = pressures
        k = self.published - 1
        if k >= 0 and self._is_sent and np.isnan(self._answer[k]):
            self._answer[k] = now - self._sent
        if self.is_waiting:
            self._held = pressures, muscles
            return
        if self.is_lockstep and not self._is_sent:
            self._plant.take(pressures, muscles)  # no command is awaited: time goes on without it
            return
        self._change_when_due()
        self._simulator.take(pressures, muscles)
        self._skip()

    def _change_when_due(self) -> None:
        while self._changes and self._plant.time >= self._changes[0][0] - 0.5 / SECOND:
            self._simulator.change(self._changes.pop(0)[1])
