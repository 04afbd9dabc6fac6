# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Softening: the force of the muscle falls with cycles or with warming."""

from dataclasses import dataclass
from math import exp
from typing import ClassVar

from pam_ros.effects.base import Compensation, Effect, EffectEquations, HiddenState, Row, Starts
from pam_ros.effects.parameter import effect_parameter, start_from, strength

LIMIT, PER_PRESSURE, PER_CONTRACTION, PER_SECOND = range(4)
# Hidden states; pressure and contraction follow with a play (backlash) that suppresses noise.
DAMAGE, PRESSURE, CONTRACTION = range(3)

# Changes within +- these bands are noise of a sensor and not part of a cycle.
BAND = 5e3  # Pa
BAND_KAPPA = 2e-3


def force(
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
    """Return f (1 - L (1 - exp(-d))): the share L, the limit, is lost for a large damage d.

    d grows with the changes of pressure and contraction, up or down, by per_pressure and
    per_contraction, and with time by per_second. Changes within +-BAND and +-BAND_KAPPA are noise.
    """
    if q[j + LIMIT] == 0.0:
        return f
    xn[i + PRESSURE] = min(max(x[i + PRESSURE], p - BAND), p + BAND)
    xn[i + CONTRACTION] = min(max(x[i + CONTRACTION], kappa - BAND_KAPPA), kappa + BAND_KAPPA)
    over_p = abs(xn[i + PRESSURE] - x[i + PRESSURE])
    over_kappa = abs(xn[i + CONTRACTION] - x[i + CONTRACTION])
    growth = q[j + PER_PRESSURE] * over_p + q[j + PER_CONTRACTION] * over_kappa
    xn[i + DAMAGE] = x[i + DAMAGE] + growth + q[j + PER_SECOND] * h
    return f * (1.0 - q[j + LIMIT] * (1.0 - exp(-xn[i + DAMAGE])))


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the states of a muscle after a rest."""
    return (0.0, p, kappa)


@dataclass(frozen=True)
class Softening(Effect):
    """Force that falls with cycles or with time and saturates."""

    limit: float = strength(
        'share of the force that is finally lost', low=-0.5, high=0.9, scale=0.05, sign=1
    )
    per_pressure: float = effect_parameter(
        0.0,
        'approach to the limit for each Pa of change of pressure, up or down',
        '1/Pa',
        low=0.0,
        high=1e-3,
        scale=2e-7,
    )
    per_contraction: float = effect_parameter(
        0.0,
        'approach to the limit for each unit of travelled contraction, up or down',
        '1/fraction',
        low=0.0,
        high=1e3,
        scale=0.3,
    )
    per_second: float = effect_parameter(
        0.0, 'approach to the limit each second', '1/s', low=0.0, high=10.0, scale=0.02
    )

    name: ClassVar = 'softening'
    text: ClassVar = 'pull that falls with cycles or with time and saturates'
    source: ClassVar = 'Mullins effect of the bladder; measured -2.9 % in ten cycles; warming'
    equation: ClassVar = (
        'F = (1 - limit (1 - exp(-d))) F_in\n'
        'dd/dt = per_pressure |dp/dt| + per_contraction |dκ/dt| + per_second\n'
        'Changes of p within +-5 kPa and of κ within +-0.002 are noise and do not count.'
    )
    signature: ClassVar = 'gain that drifts over the record, most in its first cycles'
    experiment: ClassVar = 'the first segment repeated at the end, and again after a rest'
    excitation: ClassVar = {}
    compensation: ClassVar = Compensation.FEEDBACK
    states: ClassVar = (
        HiddenState('damage', '', 0.5),
        HiddenState('pressure with play', 'Pa'),
        HiddenState('contraction with play', 'fraction'),
    )
    rivals: ClassVar = ('creep', 'leak')
    needs_muscle: ClassVar = True
    equations: ClassVar = EffectEquations(force=force, start=start)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, limit=0.03, per_pressure=1e-6),
            start_from(cls, limit=0.03, per_pressure=1e-7),
            start_from(cls, limit=0.03, per_contraction=0.3),
            start_from(cls, limit=0.03, per_second=0.1),
            start_from(cls, limit=0.03, per_second=0.01),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(limit=0.06, per_pressure=5e-7)
