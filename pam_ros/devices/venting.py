# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Slow venting of valves whose commands have stopped, at a constant rate of pressure.

A muscle that vents at once drops its load: 5 kg reach 3 m/s.
"""

from dataclasses import dataclass


@dataclass
class _Valve:
    """Present and final pressure of a valve in Pa, and the rate of change in Pa/s."""

    pressure: float
    rest: float
    speed: float


class Venting:
    """The valves that vent at present, by the numbers of their muscles."""

    def __init__(self) -> None:
        """Start without venting valves."""
        self._valves: dict[int, _Valve] = {}

    def __bool__(self) -> bool:
        """Return whether any valve vents."""
        return bool(self._valves)

    def begin(self, muscle: int, pressure: float, rest: float, time: float) -> None:
        """Start to vent a valve from *pressure* to *rest* in Pa within *time* in s.

        The rate of each valve is proportional to this change: antagonistic muscles keep the ratio
        of their pressures, so that their joint moves only a little at first.
        """
        self._valves[muscle] = _Valve(pressure, rest, abs(pressure - rest) / time)

    def end(self, muscle: int) -> None:
        """Stop the venting of a valve: it receives commands again, or has its final pressure."""
        self._valves.pop(muscle, None)

    def move(self, time: float) -> dict[int, float]:
        """Return the pressures in Pa after *time* s; end the venting at the final pressure."""
        moved = {}
        for muscle, valve in [*self._valves.items()]:
            most = valve.speed * time
            valve.pressure += min(max(valve.rest - valve.pressure, -most), most)
            moved[muscle] = valve.pressure
            if valve.pressure == valve.rest:
                self.end(muscle)
        return moved
