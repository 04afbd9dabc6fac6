# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Slack: a muscle pulls, but it cannot push, or only until it buckles."""

from dataclasses import dataclass
from typing import ClassVar

from pam_ros.compiled import scalar
from pam_ros.effects.base import Compensation, Effect, EffectEquations, Row, Starts
from pam_ros.effects.parameter import effect_parameter, start_from, strength
from pam_ros.effects.rows import A1, A2, A3, A4, A5, A6
from pam_ros.muscle.law import force as law_force

SHARE, TOE, PUSH = range(3)


@scalar
def tendon(f: float, w: float, b: float) -> float:
    """Return max(f, -b), with a corner rounded by a parabola over +-w, in N."""
    above = f + b
    if above >= w:
        return f
    if above <= -w:
        return -b
    return (above + w) * (above + w) / (4.0 * w) - b


@scalar
def engagement(f: float, w: float, b: float) -> float:
    """Return the slope of :func:`tendon` over f: 1 if the muscle pulls, 0 if it is slack."""
    above = f + b
    if above >= w:
        return 1.0
    if above <= -w:
        return 0.0
    return (above + w) / (2.0 * w)


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
    """Return f + s (tendon(f) - f): the share s of a pushing force is missing.

    The corner is rounded over the toe; at the force push the muscle buckles.
    """
    if q[j + SHARE] == 0.0:
        return f
    return f + q[j + SHARE] * (tendon(f, q[j + TOE], q[j + PUSH]) - f)


def damping(c: float, p: float, kappa: float, v: float, q: Row, j: int) -> float:
    """Return c if the muscle pulls; if it is slack, the share s of the damping is missing."""
    if q[j + SHARE] == 0.0:
        return c
    f = law_force(p, kappa, q[A1], q[A2], q[A3], q[A4], q[A5], q[A6])
    return c * (1.0 - q[j + SHARE] * (1.0 - engagement(f, q[j + TOE], q[j + PUSH])))


@dataclass(frozen=True)
class Slack(Effect):
    """No push: below its threshold pressure a shortened muscle goes slack."""

    share: float = strength(
        'share of the push of the force law that is missing; 1: the muscle cannot push',
        high=1.0,
        scale=0.3,
    )
    toe: float = effect_parameter(
        2.0,
        'force on either side of the corner over which the pull sets in',
        'N',
        low=1e-3,
        high=500.0,
        scale=10.0,
    )
    push: float = effect_parameter(
        0.0, 'push at which the slack muscle buckles', 'N', low=0.0, high=500.0, scale=5.0
    )

    name: ClassVar = 'slack'
    text: ClassVar = 'no push: below its threshold pressure a shortened muscle goes slack'
    source: ClassVar = 'Tension-only tendon with a toe; threshold pressure: Martens & Boblan 2017'
    equation: ClassVar = (
        'F = F_in + share (max(F_in, -push) - F_in)\n'
        'The corner is rounded by a parabola over +-toe. Beyond it, c = (1 - share) c_in.'
    )
    signature: ClassVar = (
        'residual only where the model would push: high contraction, low pressure'
    )
    experiment: ClassVar = (
        'vent the muscle at constant lengths beyond 10 % contraction with a force cell'
    )
    excitation: ClassVar = {'segments': ('slow_triangle',), 'pressure_min': 0.0}
    compensation: ClassVar = Compensation.MODEL
    rivals: ClassVar = ('end_stop',)
    needs_muscle: ClassVar = True
    equations: ClassVar = EffectEquations(force=force, damping=damping)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, share=1.0),
            start_from(cls, share=1.0, toe=30.0),
            start_from(cls, share=1.0, toe=30.0, push=10.0),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(share=1.0, toe=20.0)
