# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Leak: the loss is proportional to the pressure, and the valve may refill the chamber."""

from dataclasses import dataclass
from math import exp, expm1, log, log1p
from typing import ClassVar

from pam_ros.compiled import scalar
from pam_ros.effects.base import Compensation, Effect, EffectEquations, HiddenState, Row, Starts
from pam_ros.effects.parameter import effect_parameter, start_from, strength
from pam_ros.effects.pressure_lag import UNLIMITED

RATE, REFILL, SUPPLY, VENT, EXHAUST = range(5)
CHAMBER, UPSTREAM = range(2)  # hidden states: the pressures in the chamber and of p_in

SHORTEST = 1e-6  # s; faster than the refill of any rig: treated as immediate
LEAST = 1e-12  # 1/s; a leak that takes thousands of years is ignored
REOPENING = 2e3  # Pa; a change of p_in that removes the loss of a closed chamber except for 1/e


@scalar
def open_for(way: float, slope: float, r: float, left: float) -> float:
    """Return the time in s, at most *left*, until a fully open valve begins to close.

    By then the pressure changes by *way* Pa. It begins with *slope* Pa/s and changes by
    slope (1 - exp(-r t)) / r, so that it may never come so far: for example, to a pressure far
    below 0.
    """
    if slope <= r * way:
        return left
    return min(left, -log1p(-r * way / slope) / r)


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return the pressure of a leaking chamber, exact for p_in constant over h.

    With the rate r and a refill time T > 0 the valve stays open. Below p_in
    dp/dt = (p_in - p) / T - r p. Its first term is at most the supply, which is the flow through
    the fully open valve. Above p_in dp/dt = (p_in - p) / V - r p with V = vent, of which the first
    term is at least -exhaust; with V = 0 and no such limit the chamber vents at once. With T = 0
    the valve is closed between changes of p_in: the chamber follows p_in less its loss,
    dp/dt = -r p, and every change of p_in by REOPENING restores all but 1/e of the loss.
    """
    r = q[j + RATE]
    if r < LEAST:
        return p
    if q[j + REFILL] > 0.0:
        now, left = x[i + CHAMBER], h
        if now > p:
            # It vents until it reaches p_in, or for the whole step h.
            fastest = q[j + EXHAUST]
            begins = p + fastest * q[j + VENT]  # pressure at which the valve begins to close
            if fastest < UNLIMITED and now > begins:
                slope = fastest + r * now
                spent = open_for(now - begins, slope, r, left)
                now += slope * expm1(-r * spent) / r
                left -= spent
            if q[j + VENT] > SHORTEST:
                out = 1.0 / q[j + VENT] + r
                rest = p / q[j + VENT] / out
                full = left if p <= rest else -log((p - rest) / (now - rest)) / out
                spent = min(left, full)
                now = rest + (now - rest) * exp(-spent * out)
                left -= spent
            elif left > 0.0 or fastest >= UNLIMITED:
                now = p
        fill = 1.0 / max(q[j + REFILL], SHORTEST)
        if left > 0.0 and (p - now) * fill > q[j + SUPPLY]:
            # The valve is fully open until it begins to close, or for the rest of the step.
            slope = q[j + SUPPLY] - r * now
            spent = open_for(p - q[j + SUPPLY] / fill - now, slope, r, left)
            now -= slope * expm1(-r * spent) / r
            left -= spent
        rest = p * fill / (fill + r)
        xn[i + CHAMBER] = rest + (now - rest) * exp(-left * (fill + r)) if left > 0.0 else now
    else:
        lost = (x[i + UPSTREAM] - x[i + CHAMBER]) * exp(-abs(p - x[i + UPSTREAM]) / REOPENING)
        xn[i + CHAMBER] = (p - lost) * exp(-h * r)
    xn[i + UPSTREAM] = p
    return xn[i + CHAMBER]


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the balance of leak and refill."""
    return (p / (1.0 + q[j + RATE] * q[j + REFILL]), p)


@dataclass(frozen=True)
class Leak(Effect):
    """Chamber that loses pressure with time."""

    rate: float = strength(
        'share of the gauge pressure that is lost each second', '1/s', high=10.0, scale=0.02
    )
    refill: float = effect_parameter(
        0.0,
        'time constant of refilling; 0: the valve is closed between changes of the command',
        's',
        low=0.0,
        high=10.0,
        scale=0.1,
    )
    supply: float = effect_parameter(
        UNLIMITED,
        'fastest change of pressure by refilling, where the valve is fully open',
        'Pa/s',
        low=1e3,
        high=UNLIMITED,
        scale=1e6,
    )
    vent: float = effect_parameter(
        0.0,
        'time constant of venting through the open valve; 0: at once',
        's',
        low=0.0,
        high=10.0,
        scale=0.05,
    )
    exhaust: float = effect_parameter(
        UNLIMITED,
        'fastest change of pressure by venting, where the valve is fully open',
        'Pa/s',
        low=1e3,
        high=UNLIMITED,
        scale=1e6,
    )

    name: ClassVar = 'leak'
    text: ClassVar = 'chamber that loses pressure with time'
    source: ClassVar = (
        'Isothermal chamber with a laminar leak; refill through the conductance of the valve'
    )
    equation: ClassVar = (
        'p_in > p:  dp/dt = min((p_in - p) / refill, supply) - rate p\n'
        'p_in < p:  dp/dt = max((p_in - p) / vent, -exhaust) - rate p\n'
        'With vent = 0 and no limit exhaust p = p_in at once.\n'
        'With refill = 0 the valve is closed while p_in is constant: dp/dt = -rate p.\n'
        f'A change of p_in by dp_in multiplies p_in - p by exp(-|dp_in| / {REOPENING:g} Pa).'
    )
    signature: ClassVar = (
        'pressure that falls while the command is constant, and is restored by its next change'
    )
    experiment: ClassVar = 'long holds at a high pressure'
    excitation: ClassVar = {'segments': ('steps',), 'duration': 600.0}
    compensation: ClassVar = Compensation.FEEDBACK
    states: ClassVar = (HiddenState('pressure', 'Pa', 2e4), HiddenState('upstream pressure', 'Pa'))
    rivals: ClassVar = ('pressure_lag', 'pressure_offset', 'creep', 'softening')
    contains: ClassVar = {
        'pressure_lag': {
            'fill': 'refill',
            'vent': 'vent',
            'fastest': 'supply',
            'fastest_vent': 'exhaust',
        }
    }
    needs_muscle: ClassVar = True
    equations: ClassVar = EffectEquations(pressure=pressure, start=start)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, rate=0.003),
            start_from(cls, rate=0.03),
            start_from(cls, rate=0.3, refill=0.1),
            start_from(cls, rate=0.3, refill=0.1, vent=0.05),
            start_from(cls, rate=0.3, refill=0.7, vent=0.05),
            start_from(cls, rate=0.3, refill=0.1, supply=5e5),
            start_from(cls, rate=0.3, refill=0.1, supply=5e5, vent=0.05, exhaust=5e5),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(rate=0.1, refill=0.2)
