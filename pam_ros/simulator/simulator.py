# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The plant in simulated time: all of ``pam_sim`` except ROS.

It is advanced to the steps that are due in its time mode, and its samples are published.
"""

import math
from collections.abc import Callable, Sequence
from time import monotonic_ns
from typing import Protocol

from pam_ros.settings.scene import SimulationSetup
from pam_ros.simulator.modes import Mode
from pam_ros.simulator.plant import BadCommand, Plant, PlantReading
from pam_ros.timing.grid import Grid
from pam_ros.timing.interruption import Interruptions, steady_ns
from pam_ros.timing.pace import CATCH_UP, SECOND
from pam_ros.timing.ticker import Ticker


class Outputs(Protocol):
    """What publishes the samples, and the time if the simulator makes it; stamps are ns."""

    def publish_clock(self, stamp: int) -> None:
        """Publish the simulated time."""

    def publish(self, stamp: int, reading: PlantReading) -> None:
        """Publish a state of the plant."""

    def report(self, fault: str) -> None:
        """Report a fault of the simulation."""


class Simulator:
    """A plant whose time passes as its *mode* says.

    ``ticker`` says when to call :meth:`tick`. ``published`` counts the samples. ``fault`` is a
    sentence if the state became invalid: the plant was reset, and is paused.
    """

    def __init__(
        self,
        plant: Plant,
        mode: Mode,
        outputs: Outputs,
        steady: Callable[[], int] = monotonic_ns,
        uninterrupted: Callable[[], int] = steady_ns,
    ) -> None:
        """Start *plant* in its initial state; *outputs* publish its samples.

        *steady* and *uninterrupted* return times in ns of clocks that never jump; the second one
        also counts while the machine is suspended.
        """
        self.plant, self.mode, self._outputs = plant, mode, outputs
        self._steady, self._uninterrupted = steady, uninterrupted
        self.is_paused = False
        self.published = 0
        self._last: tuple[int, PlantReading] | None = None
        self._interruptions = Interruptions(uninterrupted())
        rate = plant.setup.settings.physics_rate
        self._samples, self._clock_ticks = Grid(rate), Grid(rate)
        self.ticker = Ticker(mode.tick_rate(is_paused=False))
        self._set_ticks()
        self._begin()

    def start(self) -> None:
        """Start simulated time now."""
        self._interruptions.mark(self._uninterrupted())
        self.mode.align(0)
        self._begin()
        if self.mode.turns is not None:
            self._run_to(0)

    def _begin(self) -> None:
        """Set the initial state."""
        settings = self.plant.setup.settings
        self.plant.begin()
        self.fault = ''
        self._samples.begin(settings.publish_rate)
        self._clock_ticks.begin(settings.clock_rate if self.mode.makes_time else 0.0)
        self._clock_step = -1  # the last one whose time was published on /clock
        if self.mode.turns is not None:
            self.mode.turns.begin()

    def _begin_again(self) -> None:
        """Set the initial state again; time that the simulator makes does not go back."""
        self.mode.restart(self.plant.step)
        self._begin()

    # Time ----------------------------------------------------------------------------------

    def tick(self) -> None:
        """Simulate and publish all samples that are due; if time stops, repeat the last state."""
        mode, turns = self.mode, self.mode.turns
        self._is_interrupted()
        self._interruptions.mark(self._uninterrupted())
        if self.is_paused:
            self._publish_again()
        elif turns is None or turns.is_complete:
            self._run_until_due()
            due = mode.wakes(min(self._samples.next, self._clock_ticks.next))
            if due is not None:
                self.ticker.aim(due)
        elif turns.must_repeat():
            self._publish_again()

    def _run_until_due(self, ahead: float = 0.0) -> None:
        """Simulate the steps that are due within *ahead* steps, and publish each sample.

        If the last time on ``/clock`` is that of a state that waited for commands, it is published
        again. This shows a recorder until when time stood still, and that the command was sent
        before it.
        """
        mode, step = self.mode, self.plant.step
        due = mode.due(step, self._samples.next, ahead)
        if mode.turns is not None and due > step and self._clock_step == step:
            self._outputs.publish_clock(mode.now())
        self._run_to(due, self._steady() + mode.slice)

    def _run_to(self, due: int, end: float = math.inf) -> None:
        """Simulate to the step *due*, or to the first sample after the steady time *end* in ns."""
        plant, mode, samples, clock = self.plant, self.mode, self._samples, self._clock_ticks
        try:
            while (step := min(samples.next, clock.next)) <= due:
                plant.advance(step)
                if step == clock.next:
                    self._outputs.publish_clock(mode.stamp(step))
                    self._clock_step = step
                    clock.advance()
                if step == samples.next:
                    self._publish(mode.stamp(step))
                    samples.advance()
                    if mode.turns is not None:
                        mode.turns.begin()
                if end < math.inf and self._steady() > end:
                    return
            plant.advance(due)
        except (ArithmeticError, ValueError) as error:  # errors of the kernel as plain Python
            self._stop_at_fault(error)

    def _sample_from_here(self) -> None:
        """Let the next sample be due one period from now."""
        self._samples.begin(self.plant.setup.settings.publish_rate, self.plant.step, 1)

    def _publish(self, stamp: int) -> None:
        self._last = stamp, self.plant.read()
        self._publish_reading(*self._last)

    def _publish_at(self, stamp: int) -> None:
        """Publish while time stands still; pause if new parameters made the state invalid."""
        try:
            self._publish(stamp)
        except ArithmeticError as error:
            self._stop_at_fault(error)

    def _publish_again(self) -> None:
        """Publish the present state again.

        If the simulator makes its own time, the last reading is repeated. The sensors are not read
        again, so that their noise does not depend on the length of the pause.
        """
        if not self.mode.makes_time:
            self._publish_at(self.mode.now())
        elif self._last:
            self._outputs.publish_clock(self.mode.now())
            self._publish_reading(*self._last)

    def _publish_reading(self, stamp: int, reading: PlantReading) -> None:
        self._outputs.publish(stamp, reading)
        self.published += 1

    def _stop_at_fault(self, error: Exception) -> None:
        """Reset and pause, because the state of the model is no longer valid."""
        time = self.plant.time
        self._begin_again()
        self._set_paused(True)
        self.fault = (
            f'the state is invalid {time:.3f} s after the start, {error}: reset and paused'
        )
        self._outputs.report(self.fault)

    # Commands and services -----------------------------------------------------------------

    def _is_interrupted(self) -> bool:
        """Return whether commands that arrive now may have been sent while this node was stopped.

        They belong to a time that is never simulated, and a controller without joint states may
        have sent them to vent. They are ignored: the last command before them remains active.
        """
        self._interruptions.find(self._uninterrupted(), self._longest)
        return not self.mode.makes_time and not self.is_paused and self._interruptions.is_settling

    def take(self, pressures: Sequence[float], muscles: Sequence[int]) -> BadCommand | None:
        """Command these *muscles* in Pa; return the problem of the last bad command, or None.

        A command acts from the step that is nearest to its arrival: at most half a step early or
        late, on average neither. If time waits for commands and this was the last one, a period
        is simulated.
        """
        if self._is_interrupted():
            return None
        self._run_until_now(ahead=0.5)
        bad = self.plant.take(pressures, muscles)
        turns = self.mode.turns
        if turns is not None:
            turns.take(muscles)
            if turns.is_complete and not self.is_paused:
                self._run_until_due()
        return bad

    def _run_until_now(self, ahead: float = 0.0) -> None:
        """Simulate the steps that are due, if time passes at a given pace."""
        if self.mode.speed and not self.is_paused:
            self._run_until_due(ahead)

    def change(self, setup: SimulationSetup) -> None:
        """Continue with other parameters."""
        self._run_until_now()
        before, now = self.plant.setup.settings, setup.settings
        self.plant.change(setup)
        self.mode.change(now, self.plant.step)
        if now.publish_rate != before.publish_rate:
            self._sample_from_here()
        if now.clock_rate != before.clock_rate and self.mode.makes_time:
            passed = math.floor(self.plant.time * now.clock_rate + 1e-9)
            self._clock_ticks.begin(now.clock_rate, sample=passed + 1)
        self._set_ticks()
        # Compiling takes time: the process was not stopped.
        self._interruptions.mark(self._uninterrupted())

    def reset(self) -> None:
        """Set the initial state again."""
        self._begin_again()
        if self.mode.turns is not None or self.is_paused:
            self._run_to(0)

    def pause(self, is_paused: bool) -> None:
        """Stop simulated time, or let it pass again."""
        mode = self.mode
        self._run_until_now()
        if self.is_paused and not is_paused:
            mode.align(self.plant.step)
            self.fault = ''
        if is_paused and not self.is_paused and mode.makes_time and mode.turns is None:
            self._publish_at(mode.stamp(self.plant.step))  # to be repeated
        self._set_paused(is_paused)

    def _set_paused(self, is_paused: bool) -> None:
        self.is_paused = is_paused
        self._set_ticks()

    def _set_ticks(self) -> None:
        rate = self.mode.tick_rate(is_paused=self.is_paused)
        if rate != self.ticker.rate:
            self.ticker.start(rate, self._steady())
        self._longest = max(CATCH_UP, round(3 * SECOND / rate))  # ns of running without a tick

    def step(self, is_stopped: Callable[[], bool]) -> tuple[bool, str]:
        """Simulate ``step_periods`` periods with the present commands, and publish each.

        Return whether all are done, and a sentence. *is_stopped* is asked before each period.
        """
        if not self.is_paused:
            return False, 'simulated time is not paused: pause it first'
        found = self._step(self.plant.setup.settings.step_periods, is_stopped)
        self._interruptions.mark(self._uninterrupted())  # it was busy, not stopped
        return found

    def _step(self, periods: int, is_stopped: Callable[[], bool]) -> tuple[bool, str]:
        self._sample_from_here()
        for done in range(periods):
            if is_stopped():
                return False, f'stop requested: simulated {done} of {periods} periods'
            if not self.mode.makes_time:
                # The stamp of each sample is the time at which it is published.
                self.mode.align(self._samples.next)
            self._run_to(self._samples.next)
            if self.fault:
                return False, self.fault
        return True, f'simulated {periods} periods, until {self.plant.time:.9g} s'
