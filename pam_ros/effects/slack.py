# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Slack: a muscle pulls, but cannot push, or only until it buckles."""

from pam_ros.compiled import scalar
from pam_ros.effects.base import Compensation, Effect, EffectParameter, Row
from pam_ros.effects.rows import A1, A2, A3, A4, A5, A6
from pam_ros.muscle.law import force as law_force


@scalar
def tendon(f: float, w: float, b: float) -> float:
    """Return max(f, -b), the corner rounded off by a parabola over w to either side, in N."""
    above = f + b
    if above >= w:
        return f
    if above <= -w:
        return -b
    return (above + w) * (above + w) / (4.0 * w) - b


@scalar
def engagement(f: float, w: float, b: float) -> float:
    """Return the slope of :func:`tendon` over f: 1 where it pulls, 0 where it is slack."""
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
    """Return f + s (tendon(f) - f): of what pushes, the share s = q[j] is missing.

    The toe is q[j + 1], the push at which the muscle buckles q[j + 2], both in N.
    """
    if q[j] == 0.0:
        return f
    return f + q[j] * (tendon(f, q[j + 1], q[j + 2]) - f)


def damping(c: float, p: float, kappa: float, v: float, q: Row, j: int) -> float:
    """Return c where the muscle pulls; what is slack damps no more than it pulls."""
    if q[j] == 0.0:
        return c
    f = law_force(p, kappa, q[A1], q[A2], q[A3], q[A4], q[A5], q[A6])
    return c * (1.0 - q[j] * (1.0 - engagement(f, q[j + 1], q[j + 2])))


EFFECT = Effect(
    name='slack',
    text='no push: below its threshold pressure a shortened muscle goes slack',
    source='Tension-only tendon with a toe; threshold pressure: Martens & Boblan 2017',
    parameters=(
        EffectParameter(
            'share',
            0.0,
            'share of the push of the force law that is missing; 1: the muscle cannot push',
            '',
            0.0,
            1.0,
            scale=0.3,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'toe',
            2.0,
            'force on either side of the corner over which the pull sets in',
            'N',
            1e-3,
            500.0,
            scale=10.0,
        ),
        EffectParameter(
            'push', 0.0, 'push at which the slack muscle buckles', 'N', 0.0, 500.0, scale=5.0
        ),
    ),
    signature='residual only where the model would push: high contraction, low pressure',
    experiment='vent the muscle at held lengths beyond 10 % contraction with a force cell',
    fit_starts=(
        {'share': 1.0},
        {'share': 1.0, 'toe': 30.0},
        {'share': 1.0, 'toe': 30.0, 'push': 10.0},
    ),
    example={'share': 1.0, 'toe': 20.0},
    compensation=Compensation.MODEL,
    rivals=('end_stop',),
    force=force,
    damping=damping,
    needs_muscle=True,
)
