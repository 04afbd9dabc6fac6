# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated rig behind messages that are lost or delayed, with a driver that can fail."""

import sys
from collections import deque
from collections.abc import Sequence
from math import ceil, floor, inf
from typing import NamedTuple

from pam_ros.bench.faults import FREEZE, Draws, Outage
from pam_ros.settings.scene import SimulationSetup
from pam_ros.simulator.plant import BadCommand, Plant

ROUNDING = 1e-6  # steps


class _InFlight(NamedTuple):
    """A command that arrives at a *step*."""

    step: int
    pressures: Sequence[float]
    muscles: Sequence[int]


class RemotePlant(Plant):
    """A plant whose commands are lost or delayed, and that takes none during an outage.

    The faults of a command are those of the newest sample at the time at which it was sent.
    Commands keep their order: a command with a short delay waits for those before it, as over DDS.
    """

    def __init__(
        self, setup: SimulationSetup, draws: Draws, outages: Sequence[Outage] = ()
    ) -> None:
        """Create the rig in its initial state."""
        self._draws = draws
        rate = setup.settings.physics_rate
        self._periods = setup.settings.publish_rate / rate  # in a step
        self._outages = [
            (
                ceil(one.time * rate - ROUNDING),
                sys.maxsize if one.end == inf else ceil(one.end * rate - ROUNDING),
                one.kind,
            )
            for one in outages
        ]
        super().__init__(setup)

    def begin(self) -> None:
        """Set the initial state; no command is in flight, and all outages are ahead."""
        super().begin()
        self._in_flight: deque[_InFlight] = deque()
        self._ahead = deque(begin for begin, _, kind in self._outages if kind != FREEZE)

    @property
    def is_out(self) -> bool:
        """Whether the rig neither sends states nor takes commands at present."""
        return any(begin <= self.step < end for begin, end, _ in self._outages)

    def take(self, pressures: Sequence[float], muscles: Sequence[int]) -> BadCommand | None:
        """Send a command to these *muscles* in Pa, which acts when and if it arrives.

        Return the problem of one that arrives at once, or None.
        """
        draws = self._draws
        k = min(floor(self.step * self._periods + ROUNDING), draws.delays.size - 1)
        if draws.commands_lost[k]:
            return None
        arrival = self.step + round(float(draws.delays[k]) * self.setup.settings.physics_rate)
        if self._in_flight:
            arrival = max(arrival, self._in_flight[-1].step)
        if arrival > self.step:
            self._in_flight.append(_InFlight(arrival, tuple(pressures), tuple(muscles)))
            return None
        return self._arrive(pressures, muscles)

    def _arrive(self, pressures: Sequence[float], muscles: Sequence[int]) -> BadCommand | None:
        return None if self.is_out else super().take(pressures, muscles)

    def advance(self, step: int) -> None:
        """Simulate until this step, with the commands that arrive and the valves that vent."""
        while (event := self._next_event) <= step:
            super().advance(event)
            if self._ahead and self._ahead[0] <= event:
                self._ahead.popleft()
                for muscle in self._all:
                    self._vent(muscle, self.setup.settings.vent_time)
            while self._in_flight and self._in_flight[0].step <= event:
                _, pressures, muscles = self._in_flight.popleft()
                self._arrive(pressures, muscles)
        super().advance(step)

    @property
    def _next_event(self) -> int:
        arrival = self._in_flight[0].step if self._in_flight else sys.maxsize
        return min(arrival, self._ahead[0] if self._ahead else sys.maxsize)

    def _time_out(self) -> None:
        """Let the time without commands begin again during an outage: the driver counts none."""
        if self.is_out:
            now = self._simulation.time
            self.commanded_at = [now + 0.0 * last for last in self.commanded_at]  # NaN: never
            self._set_deadline()
        else:
            super()._time_out()
