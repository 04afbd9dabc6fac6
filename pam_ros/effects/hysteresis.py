# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rate-independent hysteresis of the braid: a force that depends on the way come from."""

from math import exp

from pam_ros.effects.base import Effect, EffectParameter, Row


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
    """Return f - (A + B p) z: Dahl's law for z over s = kappa + C p, exact for any step in s.

    dz/ds = (sign(ds/dt) - z) / W, with A, B, W and C in q[j] to q[j + 3]. x[i] is z, x[i + 1]
    is s.
    """
    if q[j] == 0.0 and q[j + 1] == 0.0:
        return f
    s = kappa + q[j + 3] * p
    ds = s - x[i + 1]
    side = 1.0 if ds > 0.0 else -1.0
    xn[i] = side + (x[i] - side) * exp(-abs(ds) / q[j + 2])
    xn[i + 1] = s
    return f - (q[j] + q[j + 1] * p) * xn[i]


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the middle of the loop."""
    return (0.0, kappa + q[j + 3] * p)


EFFECT = Effect(
    name='hysteresis',
    text='rate-independent hysteresis of braid and bladder',
    source='Dahl 1968; Hunt et al. 2017 (pressure form)',
    parameters=(
        EffectParameter(
            'amplitude',
            0.0,
            'half height of the loop',
            'N',
            0.0,
            1e3,
            scale=10.0,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'per_pressure',
            0.0,
            'growth of the amplitude with pressure',
            'N/Pa',
            0.0,
            1e-2,
            scale=3e-5,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'width',
            0.01,
            'contraction over which the loop closes',
            'fraction',
            1e-5,
            1.0,
            scale=0.01,
        ),
        EffectParameter(
            'pressure_share',
            0.0,
            'contraction that a change of pressure counts for, at held length too',
            '1/Pa',
            0.0,
            1e-5,
            scale=5e-7,
        ),
    ),
    signature='loops over contraction whose area does not depend on the speed; minor loops',
    experiment='slow triangles at two rates with minor loops',
    fit_starts=(
        {'amplitude': 10.0, 'width': 0.005},
        {'amplitude': 10.0, 'width': 0.03},
        {'per_pressure': 3e-5, 'width': 0.02, 'pressure_share': 5e-7},
    ),
    states=('loop', 'path'),
    start=start,
    rivals=('coulomb_friction', 'creep'),
    force=force,
)
