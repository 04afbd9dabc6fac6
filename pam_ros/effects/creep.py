# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Creep and stress relaxation: parts of the muscle's elasticity act with a slow lag."""

from dataclasses import dataclass
from math import expm1
from typing import ClassVar

from pam_ros.compiled import scalar
from pam_ros.effects.base import Compensation, Effect, EffectEquations, HiddenState, Row, Starts
from pam_ros.effects.parameter import effect_parameter, start_from, strength
from pam_ros.effects.rows import A1, A2, A3, A4, A5, A6
from pam_ros.muscle import law
from pam_ros.muscle.law import gain

FORCE, STIFFNESS, PRESSURE, TIME, SPREAD, BALANCE = range(6)
FAST, SLOW, LAST = range(3)  # hidden states of each of the three followers


@scalar
def late(now: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return *now* minus its slow follower, exact if *now* changes linearly over h.

    The follower is the mean, with weights 1 - b and b, of two first-order lags of times T/r and
    T r: T is the time, r the spread, b the balance. x[i + FAST] and x[i + SLOW] are the lags,
    x[i + LAST] is their input at the start of the step.
    """
    change = now - x[i + LAST]
    xn[i + LAST] = now
    for n in range(2):
        r = q[j + SPREAD] if n == FAST else 1.0 / q[j + SPREAD]
        a = h * r / q[j + TIME]
        gone = -expm1(-a)
        share = gone / a if a > 0.0 else 1.0
        xn[i + n] = x[i + n] + (x[i + LAST] - x[i + n]) * gone + change * (1.0 - share)
    return now - (1.0 - q[j + BALANCE]) * xn[i + FAST] - q[j + BALANCE] * xn[i + SLOW]


def relaxing(
    f: float,
    p: float,
    kappa: float,
    v: float,
    t: float,
    h: float,
    x: Row,
    i: int,
    xn: Row,
    q: Row,
    j: int,
) -> float:
    """Return f less its delayed parts s (f - f'), K (kappa - kappa') and u (dF/dp) (p - p').

    A prime marks the slow follower of each, see :func:`late`; s is the share force, K the
    stiffness and u the share pressure. K and u describe the creep of a muscle under a load, s and
    u that of the force at a prescribed length.
    """
    if q[j + FORCE] == 0.0 and q[j + STIFFNESS] == 0.0 and q[j + PRESSURE] == 0.0:
        return f
    out = f
    if q[j + FORCE] != 0.0:
        out -= q[j + FORCE] * late(f, h, x, i, xn, q, j)
    if q[j + STIFFNESS] != 0.0:
        out -= q[j + STIFFNESS] * late(kappa, h, x, i + 3, xn, q, j)
    if q[j + PRESSURE] != 0.0:
        behind = late(p, h, x, i + 6, xn, q, j)
        out -= q[j + PRESSURE] * behind * gain(kappa, q[A1], q[A3], q[A4], q[A5])
    return out


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the fully relaxed states."""
    f = float(law.force_v(p, kappa, q[A1], q[A2], q[A3], q[A4], q[A5], q[A6]))
    return (f, f, f, kappa, kappa, kappa, p, p, p)


@dataclass(frozen=True)
class Creep(Effect):
    """Delayed parts of force, stiffness and pressure."""

    force: float = strength(
        'share of a change of force that is delayed; negative: an excess that relaxes',
        low=-0.9,
        high=0.9,
        scale=0.05,
    )
    stiffness: float = strength(
        'force per contraction that resists a quick motion and relaxes', 'N', high=1e5, scale=500.0
    )
    pressure: float = strength(
        'share of a change of pressure whose force is delayed', low=-0.9, high=0.9, scale=0.02
    )
    time: float = effect_parameter(5.0, 'mean time constant', 's', low=0.1, high=1e4, scale=5.0)
    spread: float = effect_parameter(
        1.0, 'ratio of the slow and fast time to their mean', low=1.0, high=100.0, scale=2.0
    )
    balance: float = effect_parameter(0.5, 'share of the slow part', low=0.0, high=1.0, scale=0.3)

    name: ClassVar = 'creep'
    text: ClassVar = 'parts of force, stiffness and pressure gain that act with a lag'
    source: ClassVar = 'Standard linear solid; Minh et al. 2012 for a fluidic muscle'
    equation: ClassVar = (
        "F = F_in - force (F_in - F_in') - stiffness (κ - κ') - pressure dF/dp (p - p')\n"
        'A prime marks the slow follower of a value x, the mean of two first-order lags:\n'
        "x' = (1 - balance) x1 + balance x2\n"
        'dx1/dt = (x - x1) spread / time\n'
        'dx2/dt = (x - x2) / (spread time)'
    )
    signature: ClassVar = (
        'drift after steps that slows down: of length under load, of force at constant length'
    )
    experiment: ClassVar = 'holds of several minutes after steps, up and down'
    excitation: ClassVar = {'segments': ('steps',), 'duration': 1200.0}
    compensation: ClassVar = Compensation.FEED_FORWARD
    states: ClassVar = tuple(
        HiddenState(f'{which} {of}', unit, 0.0 if which == 'last' else spread)
        for of, unit, spread in (
            ('force', 'N', 50.0),
            ('contraction', 'fraction', 0.02),
            ('pressure', 'Pa', 5e4),
        )
        for which in ('fast', 'slow', 'last')
    )
    rivals: ClassVar = ('hysteresis', 'softening', 'pressure_dependent_damping', 'leak')
    needs_muscle: ClassVar = True
    equations: ClassVar = EffectEquations(force=relaxing, start=start)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, stiffness=300.0, time=0.5),
            start_from(cls, stiffness=300.0, time=5.0),
            start_from(cls, stiffness=500.0, time=5.0, spread=3.0),
            start_from(cls, pressure=0.02, time=1.0),
            start_from(cls, pressure=0.02, time=5.0, spread=3.0),
            start_from(cls, force=0.03, time=1.0),
            start_from(cls, force=-0.03, time=10.0),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(force=-0.03, stiffness=600.0, time=0.8, spread=2.0)
