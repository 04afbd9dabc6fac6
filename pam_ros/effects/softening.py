# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Softening: the muscle pulls less and less as it is cycled or warms up."""

from math import exp

from pam_ros.effects.base import Compensation, Effect, EffectParameter, HiddenState, Row

# Moves within these bands, either way, are noise of a sensor and no part of a cycle.
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
    """Return f (1 - L (1 - exp(-d))): L = q[j] is lost when the damage d has grown large.

    d grows with the way that pressure and contraction go, up or down, by q[j + 1] per Pa and
    q[j + 2] per unit of contraction, and by q[j + 3] each second. x[i] is d; x[i + 1] and
    x[i + 2] are pressure and contraction with a play of ±BAND, which swallows noise.
    """
    if q[j] == 0.0:
        return f
    xn[i + 1] = min(max(x[i + 1], p - BAND), p + BAND)
    xn[i + 2] = min(max(x[i + 2], kappa - BAND_KAPPA), kappa + BAND_KAPPA)
    way = q[j + 1] * abs(xn[i + 1] - x[i + 1]) + q[j + 2] * abs(xn[i + 2] - x[i + 2])
    xn[i] = x[i] + way + q[j + 3] * h
    return f * (1.0 - q[j] * (1.0 - exp(-xn[i])))


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return a rested muscle."""
    return (0.0, p, kappa)


EFFECT = Effect(
    name='softening',
    text='pull that falls with cycles or with time and saturates',
    source='Mullins effect of the bladder; measured -2.9 % in ten cycles; warming',
    parameters=(
        EffectParameter(
            'limit',
            0.0,
            'share of the pull that is lost in the end',
            '',
            -0.5,
            0.9,
            scale=0.05,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'per_pressure',
            0.0,
            'approach to the limit for each Pa that the pressure moves, up or down',
            '1/Pa',
            0.0,
            1e-3,
            scale=2e-7,
        ),
        EffectParameter(
            'per_contraction',
            0.0,
            'approach to the limit for each unit of contraction that the muscle goes, up or down',
            '1/fraction',
            0.0,
            1e3,
            scale=0.3,
        ),
        EffectParameter(
            'per_second', 0.0, 'approach to the limit each second', '1/s', 0.0, 10.0, scale=0.02
        ),
    ),
    signature='gain that drifts over the record, most in its first cycles',
    experiment='the first segment repeated at the end, and again after a rest',
    fit_starts=(
        {'limit': 0.03, 'per_pressure': 1e-6},
        {'limit': 0.03, 'per_pressure': 1e-7},
        {'limit': 0.03, 'per_contraction': 0.3},
        {'limit': 0.03, 'per_second': 0.1},
        {'limit': 0.03, 'per_second': 0.01},
    ),
    example={'limit': 0.06, 'per_pressure': 5e-7},
    compensation=Compensation.FEEDBACK,
    states=(
        HiddenState('damage', '', 0.5),
        HiddenState('pressure with play', 'Pa'),
        HiddenState('contraction with play', 'fraction'),
    ),
    start=start,
    rivals=('creep', 'leak'),
    force=force,
    needs_muscle=True,
)
