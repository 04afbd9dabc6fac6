# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Valves whose commands stopped vent slowly, as soft-start valves of pneumatics do.

A muscle that vents at once drops its load: 5 kg reach 3 m/s.
"""

from dataclasses import dataclass


@dataclass
class _Valve:
    """Present pressure of a valve and the one at which it rests, Pa; how fast it moves, Pa/s."""

    pressure: float
    rest: float
    speed: float


class Venting:
    """The valves that vent now, by the numbers of their muscles."""

    def __init__(self) -> None:
        """Begin with none."""
        self._valves: dict[int, _Valve] = {}

    def __bool__(self) -> bool:
        """Return whether any valve vents."""
        return bool(self._valves)

    def begin(self, muscle: int, pressure: float, rest: float, time: float) -> None:
        """Let a valve go from *pressure* to *rest* in Pa within *time* in s.

        Each moves in proportion to its pressure: muscles that pull against each other keep the
        ratio of their pressures, which moves their joint little at first.
        """
        self._valves[muscle] = _Valve(pressure, rest, abs(pressure - rest) / time)

    def end(self, muscle: int) -> None:
        """Let a valve vent no longer: it is commanded."""
        self._valves.pop(muscle, None)

    def move(self, time: float) -> dict[int, float]:
        """Return the pressures in Pa *time* in s later; valves that rest then vent no longer."""
        moved = {}
        for muscle, valve in [*self._valves.items()]:
            most = valve.speed * time
            valve.pressure += min(max(valve.rest - valve.pressure, -most), most)
            moved[muscle] = valve.pressure
            if valve.pressure == valve.rest:
                self.end(muscle)
        return moved
