# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""End stops: a stiff pad at the upper end of the travel, and another at the lower end."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from math import hypot
from typing import ClassVar

import numpy as np

from pam_ros.effects.base import (
    Array,
    Compensation,
    Effect,
    EffectEquations,
    HiddenState,
    Interval,
    Row,
    Starts,
)
from pam_ros.effects.parameter import effect_parameter, start_from, strength
from pam_ros.effects.rows import INERTIA, LENGTH
from pam_ros.errors import ParameterError

UPPER, STIFFNESS, LOWER, LOWER_STIFFNESS, DAMPING = range(5)

LEAST_TRAVEL = 1e-6  # contraction, or rad, that a fit keeps at least between two pads


def outside(
    f: float,
    p: float,
    y: float,
    v: float,
    t: float,
    h: float,
    x: Row,
    i: int,
    xn: Row,
    q: Row,
    j: int,
) -> float:
    """Return f with the force of the pads: k d (1 + b d') at a depth d > 0 in a pad, never a pull.

    The upper pad begins at the contraction upper and has k = stiffness, the lower one at lower
    and has lower_stiffness; b is the damping. Hunt and Crossley's law: no jump at contact. A step
    of length h cannot resolve a stiffness near m/h^2 or a damping beyond m/4h, so that such values
    are reduced: between two pads even a moved mass of a fifth of the nominal m stays stable.
    """
    if q[j + STIFFNESS] == 0.0 and q[j + LOWER_STIFFNESS] == 0.0:
        return f
    xn[i] = h
    most_k = q[INERTIA] / (x[i] * x[i])
    most_c = 0.25 * q[INERTIA] / x[i]
    d = y - q[j + UPPER] * q[LENGTH]
    if d > 0.0 and q[j + STIFFNESS] > 0.0:
        spring = d * q[j + STIFFNESS] / hypot(1.0, q[j + STIFFNESS] / most_k)
        c = q[j + DAMPING] * spring
        push = spring + min(c, most_c) * v
        f -= max(push, 0.0)
    d = q[j + LOWER] * q[LENGTH] - y
    if d > 0.0 and q[j + LOWER_STIFFNESS] > 0.0:
        spring = d * q[j + LOWER_STIFFNESS] / hypot(1.0, q[j + LOWER_STIFFNESS] / most_k)
        c = q[j + DAMPING] * spring
        push = spring - min(c, most_c) * v
        f += max(push, 0.0)
    return f


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the usual step in s."""
    return (1e-3,)


def guess(t: Array, p: Array, kappa: Array, residual: Array) -> Starts:
    """Return starts with a pad just within the recorded travel, at either end."""
    low, high = (float(end) for end in np.nanquantile(kappa, [0.02, 0.98]))
    inside = 0.02 * (high - low)
    return (
        start_from(EndStop, upper=high - inside, stiffness=3e4),
        start_from(EndStop, upper=high - 10.0 * inside, stiffness=1e4),
        start_from(EndStop, lower=low + inside, lower_stiffness=3e4),
    )


@dataclass(frozen=True)
class EndStop(Effect):
    """Stiff one-sided pads at the ends of the travel."""

    upper: float = effect_parameter(
        0.25,
        'contraction at which the upper pad begins',
        'fraction',
        low=-0.5,
        high=1.0,
        scale=0.1,
    )
    stiffness: float = strength(
        'stiffness of the upper pad; 0: there is none', 'N/m', high=1e8, scale=1e5
    )
    lower: float = effect_parameter(
        0.0, 'contraction at which the lower pad begins', 'fraction', low=-0.5, high=1.0, scale=0.1
    )
    lower_stiffness: float = strength(
        'stiffness of the lower pad; 0: there is none', 'N/m', high=1e8, scale=1e5
    )
    damping: float = effect_parameter(
        2.0, 'relative growth of the push with speed', 's/m', low=0.0, high=1e3, scale=2.0
    )

    name: ClassVar = 'end_stop'
    text: ClassVar = 'stiff one-sided pads at the ends of the travel'
    source: ClassVar = 'Hunt & Crossley 1975; manufacturer: at most 25 % contraction'
    equation: ClassVar = (
        'F = F_in - max(k d (1 + damping v), 0)  with d = y - upper l0 > 0,  k = stiffness\n'
        'F = F_in + max(k d (1 - damping v), 0)  with d = lower l0 - y > 0,  k = lower_stiffness'
    )
    signature: ClassVar = 'residual only beyond a position, pushing back'
    experiment: ClassVar = 'touch it slowly, and touch it with another load'
    compensation: ClassVar = Compensation.FEEDBACK
    states: ClassVar = (HiddenState('step', 's'),)
    rivals: ClassVar = ('slack', 'length_offset')
    equations: ClassVar = EffectEquations(outside=outside, start=start, guess=guess)

    def __post_init__(self) -> None:
        """Check the values, and that two pads leave some travel between them."""
        super().__post_init__()
        if self.stiffness > 0.0 and self.lower_stiffness > 0.0 and self.lower >= self.upper:
            raise ParameterError(
                f'effects.end_stop.lower = {self.lower:g} is not allowed: give less than '
                f'effects.end_stop.upper = {self.upper:g}'
            )

    @classmethod
    def fit_bounds(
        cls, near: Mapping[str, float], fitted: Collection[str], mass: float, duration: float
    ) -> dict[str, Interval]:
        """Return bounds that keep the two pads on their sides of the middle between them."""
        if not all(near[pad] > 0.0 or pad in fitted for pad in ('stiffness', 'lower_stiffness')):
            return {}
        middle = 0.5 * (near['lower'] + near['upper'])
        return {'lower': (-np.inf, middle - LEAST_TRAVEL), 'upper': (middle, np.inf)}

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, upper=0.2, stiffness=3e4),
            start_from(cls, upper=0.12, stiffness=3e4),
            start_from(cls, lower=0.02, lower_stiffness=3e4),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(upper=0.2, stiffness=3e4)
