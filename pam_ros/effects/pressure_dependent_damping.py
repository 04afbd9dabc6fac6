# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Damping that grows with pressure, inflating and deflating apart."""

from pam_ros.effects.base import Compensation, Effect, EffectParameter, Row


def damping(c: float, p: float, kappa: float, v: float, q: Row, j: int) -> float:
    """Return c + b p, with b = q[j] while the muscle shortens and q[j + 1] while it lengthens.

    c jumps at v = 0, where the force c v is 0 and stays continuous.
    """
    if q[j] == 0.0 and q[j + 1] == 0.0:
        return c
    return c + (q[j] if v > 0.0 else q[j + 1]) * max(p, 0.0)


EFFECT = Effect(
    name='pressure_dependent_damping',
    text='damping proportional to pressure, inflating and deflating apart',
    source='Reynolds et al. 2003; Serres et al. 2009',
    parameters=(
        EffectParameter(
            'inflating',
            0.0,
            'damping per pressure while the muscle shortens',
            'N s/(m Pa)',
            0.0,
            0.1,
            scale=3e-4,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'deflating',
            0.0,
            'damping per pressure while the muscle lengthens',
            'N s/(m Pa)',
            0.0,
            0.1,
            scale=3e-4,
            strength=True,
            sign=1,
        ),
    ),
    signature='residual over velocity whose slope grows with pressure',
    experiment='a chirp at several pressures: the decay is faster at the higher one',
    fit_starts=(
        {'inflating': 1e-4, 'deflating': 1e-4},
        {'inflating': 6e-4, 'deflating': 6e-4},
    ),
    example={'inflating': 3e-4, 'deflating': 1e-4},
    compensation=Compensation.MODEL,
    rivals=('viscous_friction', 'creep'),
    damping=damping,
    needs_muscle=True,
)
