# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Creep and stress relaxation: parts of the muscle's elasticity follow slowly."""

from math import expm1

from pam_ros.compiled import scalar
from pam_ros.effects.base import Compensation, Effect, EffectParameter, HiddenState, Row
from pam_ros.effects.rows import A1, A2, A3, A4, A5, A6
from pam_ros.muscle import law
from pam_ros.muscle.law import gain


@scalar
def late(now: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return what *now* has over its slow follower, exact for a way linear over h.

    The follower is the mean, with weights 1 - b and b, of two first-order lags of times T/r and
    T r: T = q[j], r = q[j + 1], b = q[j + 2]. x[i], x[i + 1] are the lags, x[i + 2] what
    they follow.
    """
    way = now - x[i + 2]
    xn[i + 2] = now
    for n in range(2):
        r = q[j + 1] if n == 0 else 1.0 / q[j + 1]
        a = h * r / q[j]
        gone = -expm1(-a)
        share = gone / a if a > 0.0 else 1.0
        xn[i + n] = x[i + n] + (x[i + 2] - x[i + n]) * gone + way * (1.0 - share)
    return now - (1.0 - q[j + 2]) * xn[i] - q[j + 2] * xn[i + 1]


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
    """Return f less what comes late: s (f - f'), K (kappa - kappa') and u (dF/dp) (p - p').

    A prime marks the slow follower of each, see :func:`late`; s = q[j], K = q[j + 1] and
    u = q[j + 2]. The muscle under load creeps by K and u, at its held length by s and u.
    """
    if q[j] == 0.0 and q[j + 1] == 0.0 and q[j + 2] == 0.0:
        return f
    out = f
    if q[j] != 0.0:
        out -= q[j] * late(f, h, x, i, xn, q, j + 3)
    if q[j + 1] != 0.0:
        out -= q[j + 1] * late(kappa, h, x, i + 3, xn, q, j + 3)
    if q[j + 2] != 0.0:
        behind = late(p, h, x, i + 6, xn, q, j + 3)
        out -= q[j + 2] * behind * gain(kappa, q[A1], q[A3], q[A4], q[A5])
    return out


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return everything relaxed."""
    f = float(law.force_v(p, kappa, q[A1], q[A2], q[A3], q[A4], q[A5], q[A6]))
    return (f, f, f, kappa, kappa, kappa, p, p, p)


EFFECT = Effect(
    name='creep',
    text='force, stiffness and pressure of which a part acts late',
    source='Standard linear solid; Minh et al. 2012 for a fluidic muscle',
    parameters=(
        EffectParameter(
            'force',
            0.0,
            'share of a change of force that comes late; negative: surplus that relaxes',
            '',
            -0.9,
            0.9,
            scale=0.05,
            strength=True,
        ),
        EffectParameter(
            'stiffness',
            0.0,
            'force per contraction that resists a quick move and relaxes',
            'N',
            0.0,
            1e5,
            scale=500.0,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'pressure',
            0.0,
            'share of a change of pressure whose pull comes late',
            '',
            -0.9,
            0.9,
            scale=0.02,
            strength=True,
        ),
        EffectParameter('time', 5.0, 'mean time constant', 's', 0.1, 1e4, scale=5.0),
        EffectParameter(
            'spread',
            1.0,
            'ratio of the slow and fast time to their mean',
            '',
            1.0,
            100.0,
            scale=2.0,
        ),
        EffectParameter('balance', 0.5, 'part that the slow time has', '', 0.0, 1.0, scale=0.3),
    ),
    signature='drift after steps that slows down: of length under load, of force at held length',
    experiment='holds of several minutes after steps, up and down',
    fit_starts=(
        {'stiffness': 300.0, 'time': 0.5},
        {'stiffness': 300.0, 'time': 5.0},
        {'stiffness': 500.0, 'time': 5.0, 'spread': 3.0},
        {'pressure': 0.02, 'time': 1.0},
        {'pressure': 0.02, 'time': 5.0, 'spread': 3.0},
        {'force': 0.03, 'time': 1.0},
        {'force': -0.03, 'time': 10.0},
    ),
    example={'force': -0.03, 'stiffness': 600.0, 'time': 0.8, 'spread': 2.0},
    compensation=Compensation.FEED_FORWARD,
    states=tuple(
        HiddenState(f'{which} {of}', unit, 0.0 if which == 'last' else spread)
        for of, unit, spread in (
            ('force', 'N', 50.0),
            ('contraction', 'fraction', 0.02),
            ('pressure', 'Pa', 5e4),
        )
        for which in ('fast', 'slow', 'last')
    ),
    start=start,
    rivals=('hysteresis', 'softening', 'pressure_dependent_damping', 'leak'),
    force=force,
    needs_muscle=True,
)
