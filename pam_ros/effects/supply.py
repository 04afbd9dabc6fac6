# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Supply: the reservoir from which all muscles of a joint fill loses pressure while they do."""

from dataclasses import dataclass
from math import exp
from typing import ClassVar

import numpy as np

from pam_ros.effects.base import (
    ENOUGH,
    Array,
    Compensation,
    Effect,
    EffectEquations,
    HiddenState,
    Row,
    Starts,
)
from pam_ros.effects.parameter import effect_parameter, start_from, strength

SHARE, LEVEL, RECOVERY = range(3)


def reservoir(taken: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return the pressure of dp/dt = (level - p) / recovery - share sum dp_i/dt after h.

    x[i] is its pressure at the start of the step, and *taken* the sum of the rises dp_i.
    """
    if q[j + SHARE] == 0.0:
        return ENOUGH
    level = q[j + LEVEL]
    refilled = level + (x[i] - level) * exp(-h / q[j + RECOVERY])
    xn[i] = refilled - q[j + SHARE] * taken
    return xn[i]


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the pressure of the full reservoir."""
    return (q[j + LEVEL],)


def guess(t: Array, p: Array, kappa: Array, residual: Array) -> Starts:
    """Return starts whose reservoir, when it is full, has about the highest pressures."""
    return tuple(
        start_from(Supply, share=share, level=float(np.quantile(p, part)), recovery=recovery)
        for part in (0.9, 1.0)
        for share, recovery in ((0.05, 1.0), (0.2, 1.0))
    )


@dataclass(frozen=True)
class Supply(Effect):
    """Reservoir whose pressure falls while the muscles fill from it."""

    share: float = strength(
        'volume of a muscle divided by that of the reservoir', high=10.0, scale=0.1
    )
    level: float = effect_parameter(
        6e5, 'gauge pressure of the full reservoir', 'Pa', low=1e4, high=3e6, scale=5e4
    )
    recovery: float = effect_parameter(
        1.0,
        'time constant in which the reservoir is refilled',
        's',
        low=1e-3,
        high=1e4,
        scale=1.0,
    )

    name: ClassVar = 'supply'
    text: ClassVar = 'reservoir whose pressure falls while the muscles fill from it'
    source: ClassVar = (
        'Isothermal balance of air; muscles of equal and constant volume; a regulator or a '
        'compressor refills the reservoir in proportion to what is missing'
    )
    equation: ClassVar = (
        'u_i = min(u_in_i, p_s)\n'
        'dp_s/dt = (level - p_s) / recovery - share sum_i dp_i/dt\n'
        'The sum is over the muscles whose pressure p_i rises, and those with u_in_i > p_s.\n'
        'A muscle vents into the atmosphere as far as u_in_i tells it to.'
    )
    signature: ClassVar = (
        'high pressures are not reached at first, least of all while several muscles fill, and '
        'are then approached slowly'
    )
    experiment: ClassVar = 'steps of all muscles to their highest pressure'
    excitation: ClassVar = {'segments': ('steps',)}
    compensation: ClassVar = Compensation.FEEDBACK
    states: ClassVar = (HiddenState('pressure', 'Pa', 2e4),)
    rivals: ClassVar = ('pressure_lag', 'leak', 'softening')
    needs_muscle: ClassVar = True
    equations: ClassVar = EffectEquations(reservoir=reservoir, start=start, guess=guess)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, share=0.1, level=4e5, recovery=1.0),
            start_from(cls, share=0.3, level=5e5, recovery=3.0),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(share=0.3, level=3.2e5, recovery=2.0)
