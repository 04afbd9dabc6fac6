# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pressure lag: valve, tube and chamber fill and vent with separate time constants.

The valve of a regulator can have a dead zone, because its spool overlaps the ports or because its
electronics ignore small errors: it stays closed until the command differs by more than this from
the pressure. Data sheets call it the hysteresis or the sensitivity of the regulator.
"""

from dataclasses import dataclass
from math import exp, sqrt
from typing import ClassVar

from pam_ros.compiled import scalar
from pam_ros.effects.base import Compensation, Effect, EffectEquations, HiddenState, Row, Starts
from pam_ros.effects.parameter import effect_parameter, start_from, strength

FILL, VENT, FASTEST, FASTEST_VENT, CHOKING, SUPPLY, DEAD_ZONE = range(7)

SHORTEST = 1e-6  # s; faster than the chamber of any rig: treated as immediate
UNLIMITED = 1e9  # Pa/s, the highest value of both limits of the rate: treated as none
ATMOSPHERE = 1.013e5  # Pa
CRITICAL = 0.35  # pressure ratio below which a flow is choked; valves have 0.2 to 0.5
P_REFERENCE = 3e5  # Pa, at which the time constants hold for any choking


@scalar
def conductance(upstream: float, downstream: float) -> float:
    """Return the flow from *upstream* to *downstream*, Pa absolute; if choked, it is *upstream*.

    ISO 6358: an ellipse between the critical ratio and equal pressures.
    """
    over = (downstream / upstream - CRITICAL) / (1.0 - CRITICAL)
    if over <= 0.0:
        return upstream
    if over >= 1.0:
        return 0.0
    return upstream * sqrt(1.0 - over * over)


@scalar
def pace(p_in: float, x: float, supply: float, choking: float) -> float:
    """Return the rate at which a chamber of pressure x fills or vents, relative to 300 kPa."""
    now, reference = max(x, 0.0) + ATMOSPHERE, P_REFERENCE + ATMOSPHERE
    if p_in > x:
        source = max(supply, P_REFERENCE + 1.0) + ATMOSPHERE
        share = conductance(source, now) / conductance(source, reference)
    else:
        share = conductance(now, ATMOSPHERE) / conductance(reference, ATMOSPHERE)
    return 1.0 + choking * (share - 1.0)


@scalar
def approached(p_in: float, x: float, h: float, tau: float, fastest: float) -> float:
    """Return the pressure after h, from x, for a constant p_in.

    The rate is at most *fastest*; below this limit the pressure follows a lag of tau. Without both
    it jumps, also with h = 0: an integrator would take a pressure that moves within the step for
    one that moves over the whole step.
    """
    if tau <= SHORTEST and fastest >= UNLIMITED:
        return p_in
    left = abs(p_in - x)
    choked = min(h, max(left - fastest * tau, 0.0) / fastest)
    left -= choked * fastest
    if tau > SHORTEST:
        left *= exp(-(h - choked) / tau)
    elif choked < h:
        left = 0.0
    return p_in - left if p_in > x else p_in + left


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return the chamber pressure of dp/dt = g (p_in - p)/tau, for p_in constant over h.

    p_in is the edge of the dead zone that x[i] approaches, or x[i] itself within the zone. tau is
    fill while the chamber fills and vent while it vents; x[i] is its pressure. It never crosses
    p_in, so that tau is constant over h. The rates of filling and venting are at most g times
    fastest and fastest_vent, the limits of a fully open valve. Without choking g is 1, and the
    result is exact. With choking = 1 the flow is that of ISO 6358 from the supply and into the
    atmosphere, relative to that at 300 kPa; g is evaluated at half the step.
    """
    zone = q[j + DEAD_ZONE]
    if q[j + FILL] == 0.0 and q[j + VENT] == 0.0 and zone == 0.0:
        return p
    p = min(max(x[i], p - zone), p + zone)
    side = 0 if p > x[i] else 1
    tau, fastest = q[j + FILL + side], q[j + FASTEST + side]
    if q[j + CHOKING] > 0.0:
        g = pace(p, x[i], q[j + SUPPLY], q[j + CHOKING])
        g = pace(p, approached(p, x[i], 0.5 * h * g, tau, fastest), q[j + SUPPLY], q[j + CHOKING])
        h = h * g
    xn[i] = approached(p, x[i], h, tau, fastest)
    return xn[i]


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the upstream pressure, which the chamber has reached."""
    return (p,)


def chamber(q: Row, j: int) -> tuple[float, float, float]:
    """Return the time constants in s and the dead zone in Pa, which a controller inverts."""
    return q[j + FILL], q[j + VENT], q[j + DEAD_ZONE]


@dataclass(frozen=True)
class PressureLag(Effect):
    """First-order lag of the chamber behind the command, and dead zone of its valve."""

    fill: float = strength('time constant of filling', 's', high=10.0, scale=0.05)
    vent: float = strength('time constant of venting', 's', high=10.0, scale=0.05)
    fastest: float = effect_parameter(
        UNLIMITED,
        'fastest rise of pressure, where the valve is fully open or choked',
        'Pa/s',
        low=1e3,
        high=UNLIMITED,
        scale=1e6,
    )
    fastest_vent: float = effect_parameter(
        UNLIMITED,
        'fastest fall of pressure, in the same way',
        'Pa/s',
        low=1e3,
        high=UNLIMITED,
        scale=1e6,
    )
    choking: float = effect_parameter(
        0.0,
        'dependence of flows on the pressures at the valve; 1: as an orifice, ISO 6358',
        low=0.0,
        high=1.0,
        scale=0.3,
    )
    supply: float = effect_parameter(
        8e5,
        'gauge supply pressure of the valve, used with choking',
        'Pa',
        low=1e5,
        high=3e6,
        scale=1e5,
    )
    dead_zone: float = strength(
        'difference of command and pressure up to which the valve stays closed',
        'Pa',
        high=1e5,
        scale=5e3,
    )

    name: ClassVar = 'pressure_lag'
    text: ClassVar = (
        'first-order lag of the chamber pressure, separate for filling and venting; dead zone of '
        'the valve'
    )
    source: ClassVar = (
        'ISO 6358 orifice, linear below choking; 20 to 130 ms with servo valves; dead zones of '
        'regulators are 0.2 to 1 % of their range'
    )
    equation: ClassVar = (
        'dp/dt = g (p_v - p) / T\n'
        'p_v = min(max(p, p_in - dead_zone), p_in + dead_zone)\n'
        'T = fill while p_v > p, otherwise vent\n'
        '-g fastest_vent <= dp/dt <= g fastest\n'
        'g = 1 + choking (Q(p) / Q(300 kPa) - 1)\n'
        'Q(p) is the flow of ISO 6358 with the critical pressure ratio 0.35:\n'
        'from the supply while the chamber fills, into the atmosphere while it vents.'
    )
    signature: ClassVar = (
        'phase that rolls off with frequency; rounded step responses; with a dead zone, loops '
        'over the command that do not depend on the speed'
    )
    experiment: ClassVar = 'steps up and down, or a chirp'
    excitation: ClassVar = {'segments': ('steps', 'chirps')}
    compensation: ClassVar = Compensation.PATH
    states: ClassVar = (HiddenState('pressure', 'Pa', 2e4),)
    rivals: ClassVar = ('dead_time', 'leak', 'pressure_hysteresis')
    equations: ClassVar = EffectEquations(pressure=pressure, start=start, chamber=chamber)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, fill=0.02, vent=0.02),
            start_from(cls, fill=0.1, vent=0.1),
            start_from(cls, fill=0.5, vent=0.5),
            start_from(cls, fill=0.05, vent=0.05, fastest=5e5),
            start_from(cls, fill=0.05, vent=0.05, dead_zone=4e3),
            start_from(cls, dead_zone=4e3),
            start_from(cls, fill=0.05, vent=0.05, fastest=5e5, fastest_vent=5e5, choking=0.5),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(fill=0.05, vent=0.09)
