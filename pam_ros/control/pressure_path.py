# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The path of the pressure from the command to the chamber, and its inverse.

Dead time, offset, gain, dead band, lag and dead zone are those of the configured effects whose
compensation is ``PATH``.
"""

from collections import deque
from dataclasses import dataclass
from math import exp

from pam_ros.control.tuning import JointScale, number
from pam_ros.effects.base import Compensation, EffectEquations
from pam_ros.errors import ParameterError
from pam_ros.rig import layout as at
from pam_ros.rig.joint import Joint
from pam_ros.rig.layout import delays_of
from pam_ros.sizes import tuned_sizes_of

LOW, HIGH = 2.0 / 3.0, 5.0 / 6.0  # of p_max: least pressures beyond the dead bands
# Share of a dead zone over which its compensation grows. A smaller one leaves less of the zone and
# commands more noise.
GROWS_OVER = 0.3


@dataclass(frozen=True)
class PathTuning:
    """Pressures beyond the dead bands, between which a path is an offset and a gain."""

    low: float = number(4e5, 'Pa', 'two thirds of a p_max of 0.6 MPa')
    high: float = number(5e5, 'Pa', 'five sixths of a p_max of 0.6 MPa')


class Chamber:
    """A chamber with a first-order lag, with separate time constants to fill and to vent.

    The valve stays closed while the pressure upstream differs by less than *zone* Pa from that in
    the chamber.
    """

    def __init__(self, fill: float = 0.0, vent: float = 0.0, zone: float = 0.0) -> None:
        """Take the time constants in s and the dead zone in Pa; 0: none of these."""
        self.fill, self.vent, self.zone = fill, vent, zone
        self.pressure = 0.0

    def follow(self, inflow: float, dt: float) -> float:
        """Advance by *dt* s with *inflow* Pa upstream; return the mean pressure in this time."""
        before, zone = self.pressure, self.zone
        inflow = min(max(before, inflow - zone), inflow + zone)
        tau = self.fill if inflow > before else self.vent
        left = exp(-dt / tau) if tau > 1e-6 else 0.0
        self.pressure = inflow + (before - inflow) * left
        return 0.5 * (before + self.pressure)


class PressurePath:
    """The pressure in the chamber of a muscle, predicted from the commands.

    *quickest* is the shortest time constant in s to which the inverse reduces a lag: a shorter
    one would cost too much pressure, since noise is amplified by lag / quickest.
    """

    def __init__(self, joint: Joint, muscle: int, quickest: float) -> None:
        """Take the configured effects of one *muscle*."""
        q, layout = joint.parameters(), joint.layout
        row = q[at.MUSCLE + muscle].tolist()
        fill = vent = zone = 0.0
        self._row = row
        self._static: list[tuple[EffectEquations, int]] = []  # those without a memory
        for effect in joint.present[at.MUSCLE + muscle]:
            if effect.compensation is not Compensation.PATH:
                continue
            j = layout.parameter_at[effect.name]
            if effect.equations.chamber is not None:
                fill, vent, zone = effect.equations.chamber(row, j)
            else:
                self._static.append((effect.equations, j))
        p_max = joint.muscles[muscle].p_max
        tuning = JointScale(tuned_sizes_of(joint)).of(PathTuning())
        below, above = max(tuning.low, LOW * p_max), max(tuning.high, HIGH * p_max)
        low, high = self.reached(below), self.reached(above)
        if low <= self.reached(0.0):
            raise ParameterError(
                f'a command of {below:g} Pa does not raise the pressure in the chamber, and p_max '
                f'of the muscle is {p_max:g} Pa: a smaller dead band is needed for control'
            )
        self._gain = (high - low) / (above - below)
        self._offset = low - self._gain * below
        self.is_lag_configured = max(fill, vent) > 0.0
        self.chamber = Chamber(fill, vent, zone)
        self.delay = delays_of(layout, q)[muscle]
        self.quickest = quickest
        self.start(0.0)

    def set_lag(self, fill: float, vent: float) -> None:
        """Invert these time constants in s from now on."""
        self.chamber.fill, self.chamber.vent = fill, vent

    def set_quickest(self, quickest: float) -> None:
        """Reduce a lag to this time constant in s from now on."""
        self.quickest = quickest

    def start(self, command: float) -> None:
        """Start again a long time after a *command* in Pa."""
        self._queue: deque[tuple[float, float]] = deque()
        self._time = 0.0
        self.inflow = self.chamber.pressure = self.reached(command)

    def reached(self, command: float) -> float:
        """Return the steady pressure of the chamber in Pa under a *command*."""
        for equations, j in self._static:
            command = equations.resting_pressure(command, self._row, j)
        return command

    def command_at_rest(self, pressure: float) -> float:
        """Return the command in Pa whose steady pressure in the chamber is *pressure*.

        For a pressure of 0 it is the edge of a dead band, so that the muscle can pull at once.
        """
        return (pressure - self._offset) / self._gain

    def command_for(self, pressure: float, rate: float) -> float:
        """Return the command in Pa that brings the chamber to *pressure*, which changes at *rate*.

        The predicted part of *pressure* has the known *rate* in Pa/s. It is commanded in advance
        by the delay of the path: dead time and lag, of the lag at most ``quickest``. The rest of
        a longer lag is compensated by ``u = p + r (p - chamber)``, r = lag / quickest - 1, which
        closes a loop with the time constant ``quickest`` around the lag. A dead zone is added in
        the direction in which the chamber must go.
        """
        chamber = self.chamber
        fill, vent, quickest = chamber.fill, chamber.vent, self.quickest
        lag = min(0.5 * (fill + vent), quickest)
        ahead = pressure + (self.delay + lag) * rate
        tau = fill if ahead > chamber.pressure else vent
        drive = max(tau / quickest - 1.0, 0.0)
        upstream = ahead + drive * (ahead - chamber.pressure)
        if chamber.zone:
            share = (upstream - chamber.pressure) / (GROWS_OVER * chamber.zone)
            upstream += chamber.zone * min(max(share, -1.0), 1.0)
        return self.command_at_rest(upstream)

    def follow(self, command: float, dt: float) -> float:
        """Apply a *command* in Pa for *dt* s; return the mean pressure in the chamber."""
        queue, now = self._queue, self._time
        queue.append((now + self.delay, command))
        while queue and queue[0][0] <= now + 0.5 * dt:
            self.inflow = self.reached(queue.popleft()[1])
        self._time = now + dt
        return self.chamber.follow(self.inflow, dt)
