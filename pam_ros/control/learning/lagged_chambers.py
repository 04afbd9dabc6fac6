# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The chambers of all muscles with a learned lag, and how their effort depends on this lag."""

from collections.abc import Sequence
from math import exp
from typing import NamedTuple

from pam_ros.control.model import Pressures
from pam_ros.control.muscle_model import MusclePlace
from pam_ros.control.pressure_path import Chamber


class LagEffects(NamedTuple):
    """Pressures with the lag in Pa, and efforts of the joint that follow from it in N.

    by_fill, by_vent
        sensitivities of the missing effort to both time constants, N/s
    less, late
        effort beyond that of other pressures, which the law assumes, and of chambers without a lag
    """

    pressures: list[float]
    by_fill: float
    by_vent: float
    less: float
    late: float


class _Sensitivity:
    """Sensitivity of the pressure of a chamber to its two time constants, Pa/s."""

    def __init__(self) -> None:
        self.fill = self.vent = 0.0

    def follow(self, rate: float, fills: bool, tau: float, dt: float) -> None:
        """Advance by *dt* s in which the pressure changed at *rate* Pa/s."""
        share = 1.0 - exp(-dt / (tau if tau > dt else dt))
        self.fill += share * ((-rate if fills else 0.0) - self.fill)
        self.vent += share * ((0.0 if fills else -rate) - self.vent)


class LaggedChambers:
    """One chamber for each muscle, all with the same lag."""

    def __init__(self, zones: Sequence[float], pressures: Pressures) -> None:
        """Begin at *pressures* Pa; *zones* are the dead zones of the valves in Pa."""
        self._chambers = [Chamber(zone=zone) for zone in zones]
        self._at_once = [*pressures]  # of chambers without a lag
        self.restart(pressures)

    def restart(self, pressures: Pressures) -> None:
        """Begin again at *pressures* Pa, without sensitivities."""
        for chamber, pressure in zip(self._chambers, pressures, strict=True):
            chamber.pressure = pressure
        self._sensitivities = [_Sensitivity() for _ in pressures]

    def follow(
        self,
        dt: float,
        inflows: Pressures,
        lag: tuple[float, float],
        places: Sequence[MusclePlace],
        assumed: Sequence[float],
    ) -> LagEffects:
        """Advance by *dt* s with *inflows* Pa at the inlets and the *lag* (fill, vent) in s.

        *places* are those of the muscles, *assumed* the pressures in Pa that the law assumes.
        """
        fill, vent = lag
        pressures = []
        by_fill = by_vent = less = late = 0.0
        for i, place in enumerate(places):
            chamber, sensitivity = self._chambers[i], self._sensitivities[i]
            gain, inflow, before = place.arm * place.gain, inflows[i], chamber.pressure
            zone = chamber.zone
            chamber.fill, chamber.vent = fill, vent
            fills = inflow > before
            pressure = chamber.follow(inflow, dt)
            if abs(inflow - before) >= zone:  # while the valve is closed, nothing changes
                rate = (chamber.pressure - before) / dt
                sensitivity.follow(rate, fills, fill if fills else vent, dt)
            self._at_once[i] = at_once = min(max(self._at_once[i], inflow - zone), inflow + zone)
            by_fill += -gain * sensitivity.fill
            by_vent += -gain * sensitivity.vent
            less += gain * (pressure - assumed[i])
            late += gain * (pressure - at_once)
            pressures.append(pressure)
        return LagEffects(pressures, by_fill, by_vent, less, late)
