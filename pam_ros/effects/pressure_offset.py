# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pressure offset: regulator or sensor reads wrong by an offset and a gain."""

from pam_ros.effects.base import Compensation, Effect, EffectParameter, Row


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return (1 + q[j + 1]) p + q[j], with the offset q[j] in Pa."""
    return p + (q[j] + q[j + 1] * p)


EFFECT = Effect(
    name='pressure_offset',
    text='offset and gain error of the pressure regulator or sensor',
    source='Affine sensor model',
    parameters=(
        EffectParameter(
            'offset',
            0.0,
            'pressure in the chamber at a command of 0',
            'Pa',
            -2e5,
            2e5,
            scale=1e4,
            strength=True,
        ),
        EffectParameter(
            'gain',
            0.0,
            'relative error of the pressure',
            '',
            -0.5,
            0.5,
            scale=0.05,
            strength=True,
        ),
    ),
    signature='residual proportional to dF/dp, to p dF/dp for the gain',
    experiment='a second pressure sensor at the muscle, or its force over pressure at two lengths',
    fit_starts=({'offset': 5e3}, {'offset': -5e3}, {'offset': 1e3, 'gain': 0.03}),
    example={'offset': 6e3, 'gain': -0.03},
    compensation=Compensation.PATH,
    rivals=('payload', 'length_offset', 'leak', 'dead_band'),
    pressure=pressure,
)
