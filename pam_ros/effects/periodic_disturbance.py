# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Periodic disturbance: a sinusoid in the force on the load, or in the supply pressure."""

from math import cos, pi, sin

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
    """Return f + a sin(w t) + b cos(w t), a, b = q[j], q[j + 1], w = 2 pi q[j + 4]."""
    if q[j] == 0.0 and q[j + 1] == 0.0:
        return f
    angle = 2.0 * pi * q[j + 4] * t
    return f + (q[j] * sin(angle) + q[j + 1] * cos(angle))


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return p + a sin(w t) + b cos(w t), with a, b = q[j + 2], q[j + 3] in Pa."""
    if q[j + 2] == 0.0 and q[j + 3] == 0.0:
        return p
    angle = 2.0 * pi * q[j + 4] * t
    return p + (q[j + 2] * sin(angle) + q[j + 3] * cos(angle))


EFFECT = Effect(
    name='periodic_disturbance',
    text='sinusoid in the force between muscle and load, or ripple of the supply pressure',
    source='Harmonic disturbance; linear in its sine and cosine amplitudes',
    parameters=(
        EffectParameter(
            'force_sin',
            0.0,
            'sine part of the force',
            'N',
            -1e4,
            1e4,
            scale=5.0,
            strength=True,
        ),
        EffectParameter(
            'force_cos',
            0.0,
            'cosine part of the force',
            'N',
            -1e4,
            1e4,
            scale=5.0,
            strength=True,
        ),
        EffectParameter(
            'pressure_sin',
            0.0,
            'sine part of the supply pressure',
            'Pa',
            -2e5,
            2e5,
            scale=2e3,
            strength=True,
        ),
        EffectParameter(
            'pressure_cos',
            0.0,
            'cosine part of the supply pressure',
            'Pa',
            -2e5,
            2e5,
            scale=2e3,
            strength=True,
        ),
        EffectParameter('frequency', 1.0, 'frequency', 'Hz', 0.0, 500.0, scale=1.0),
    ),
    signature='a narrow line in the spectrum of the residual',
    experiment='a rest at constant pressure: what is left moves by itself; log the supply',
    fit_starts=(
        {'force_sin': 2.0, 'force_cos': 2.0, 'frequency': 1.0},
        {'pressure_sin': 1e3, 'pressure_cos': 1e3, 'frequency': 1.0},
    ),
    force=force,
    pressure=pressure,
)
