# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Creep and stress relaxation: parts of the muscle's elasticity follow slowly."""

from math import expm1

from pam_ros.effects.base import Effect, EffectParameter, Row
from pam_ros.muscle import law
from pam_ros.rig.layout import A1, A2, A3, A4, A5, A6


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
    """Return f - s (f - f_slow) - K (kappa - kappa_slow), with s = q[j] and K = q[j + 1].

    Both slow parts are means of two first-order lags of times T/r and T r, with T = q[j + 2]
    and r = q[j + 3], exact for an f and a kappa that are linear over h. x[i + 4] and x[i + 5]
    are f and kappa before.
    """
    if q[j] == 0.0 and q[j + 1] == 0.0:
        return f
    df = f - x[i + 4]
    dk = kappa - x[i + 5]
    xn[i + 4] = f
    xn[i + 5] = kappa
    for n in range(2):
        r = q[j + 3] if n == 0 else 1.0 / q[j + 3]
        a = h * r / q[j + 2]
        gone = -expm1(-a)
        late = gone / a if a > 0.0 else 1.0
        xn[i + n] = x[i + n] + (x[i + 4] - x[i + n]) * gone + df * (1.0 - late)
        xn[i + 2 + n] = x[i + 2 + n] + (x[i + 5] - x[i + 2 + n]) * gone + dk * (1.0 - late)
    return (
        f
        - q[j] * (f - 0.5 * (xn[i] + xn[i + 1]))
        - q[j + 1] * (kappa - 0.5 * (xn[i + 2] + xn[i + 3]))
    )


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return everything relaxed."""
    f = law.force_v(p, kappa, q[A1], q[A2], q[A3], q[A4], q[A5], q[A6])
    return (f, f, kappa, kappa, f, kappa)


EFFECT = Effect(
    name='creep',
    text='force and stiffness of which a part follows slowly',
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
        EffectParameter('time', 5.0, 'mean time constant', 's', 1e-3, 1e4, scale=5.0),
        EffectParameter(
            'spread',
            1.0,
            'ratio of the slow and fast time to their mean',
            '',
            1.0,
            100.0,
            scale=2.0,
        ),
    ),
    signature='drift after steps that slows down: of length under load, of force at held length',
    experiment='holds of several minutes after steps, up and down',
    fit_starts=(
        {'stiffness': 300.0, 'time': 0.5},
        {'stiffness': 300.0, 'time': 5.0},
        {'stiffness': 500.0, 'time': 5.0, 'spread': 3.0},
        {'force': 0.03, 'time': 1.0},
        {'force': -0.03, 'time': 10.0},
    ),
    states=(
        'fast force',
        'slow force',
        'fast contraction',
        'slow contraction',
        'force',
        'contraction',
    ),
    start=start,
    rivals=('hysteresis', 'softening', 'pressure_dependent_damping', 'leak'),
    force=force,
    needs_muscle=True,
)
