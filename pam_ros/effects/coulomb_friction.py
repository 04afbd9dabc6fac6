# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Coulomb and Stribeck friction of the guide, with a load that truly sticks."""

from math import exp, hypot, sqrt

from pam_ros.compiled import scalar
from pam_ros.effects.base import Compensation, Effect, EffectParameter, HiddenState, Row
from pam_ros.effects.rows import INERTIA


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
    """Return f less the friction, which opposes motion and holds a load at rest.

    The contact has a damper. For a step of length h = x[i + 2] that cannot resolve its spring, it
    is longer, so that its frequency on the load stays below 1/h.
    """
    if q[j] == 0.0 and q[j + 1] == 0.0 and q[j + 3] == 0.0:
        return f
    xn[i + 2] = h
    return f - resistance(p, y, v, x[i + 2], 1.0, x, i, xn, q, j)


def drag(
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
    """Return f less the friction along a prescribed motion: nothing swings on the contact."""
    if q[j] == 0.0 and q[j + 1] == 0.0 and q[j + 3] == 0.0:
        return f
    return f - resistance(p, y, v, 0.0, 0.0, x, i, xn, q, j)


@scalar
def resistance(
    p: float,
    y: float,
    v: float,
    step: float,
    damping: float,
    x: Row,
    i: int,
    xn: Row,
    q: Row,
    j: int,
) -> float:
    """Return the friction in N against an upward motion, and keep the state of the contact.

    Level: g = C + (S - C) exp(-(v / w)^2) + B p, with C, S, w, B = q[j] to q[j + 3] and S not
    below C; (1 + A) g upwards and (1 - A) g downwards, A = q[j + 4]. Below it the contact is a
    spring of length q[j + 5], lengthened for a *step* in s, x[i] its force and x[i + 1] the
    position before, with *damping* times that of an aperiodic load; both together never exceed g
    (Prandtl's element: no drift under loads that change).
    """
    level = q[j] + q[j + 3] * max(p, 0.0)
    if q[j + 1] > q[j]:
        level += (q[j + 1] - q[j]) * exp(-(v / q[j + 2]) * (v / q[j + 2]))
    up, down = (1.0 + q[j + 4]) * level, (1.0 - q[j + 4]) * level
    k = level / hypot(q[j + 5], level * step * step / q[INERTIA])
    spring = min(max(x[i] + k * (y - x[i + 1]), -down), up)
    xn[i] = spring
    xn[i + 1] = y
    return min(max(spring + damping * sqrt(k * q[INERTIA]) * v, -down), up)


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return a contact without load."""
    return (0.0, y, 1e-3)


EFFECT = Effect(
    name='coulomb_friction',
    text='dry friction of the guide with stiction and Stribeck effect',
    source='Coulomb, Stribeck; Prandtl element for presliding; Dupont et al. 2002 on drift',
    parameters=(
        EffectParameter(
            'level',
            0.0,
            'friction while it slides',
            'N',
            0.0,
            1e4,
            scale=5.0,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'breakaway',
            0.0,
            'friction at rest; counts where it is above the level',
            'N',
            0.0,
            1e4,
            scale=5.0,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'stribeck_speed',
            0.01,
            'speed at which the surplus at rest has fallen to 1/e',
            'm/s',
            1e-4,
            10.0,
            scale=0.01,
        ),
        EffectParameter(
            'per_pressure',
            0.0,
            'growth of the friction with pressure',
            'N/Pa',
            0.0,
            1e-2,
            scale=1e-5,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'asymmetry',
            0.0,
            'friction upwards less that downwards, relative to their sum',
            '',
            -1.0,
            1.0,
            scale=0.1,
        ),
        EffectParameter(
            'presliding',
            1e-5,
            'way of the contact until it slides',
            'm',
            1e-6,
            2e-4,
            scale=1e-5,
        ),
    ),
    signature='residual force that jumps with the sign of velocity; rests in the turns',
    experiment='slow triangles and micro-reversals: the force turns over within micrometres',
    fit_starts=(
        {'level': 3.0},
        {'level': 15.0, 'asymmetry': 0.0},
        {'level': 5.0, 'breakaway': 8.0, 'stribeck_speed': 0.01},
        {'level': 10.0, 'breakaway': 13.0, 'stribeck_speed': 0.02},
    ),
    example={'level': 4.0, 'breakaway': 5.0},
    compensation=Compensation.FEED_FORWARD,
    states=(
        HiddenState('contact force', 'N', 5.0),
        HiddenState('position', 'm'),
        HiddenState('step', 's'),
    ),
    start=start,
    rivals=('hysteresis', 'viscous_friction'),
    outside=outside,
    drag=drag,
)
