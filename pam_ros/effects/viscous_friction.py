# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Viscous friction of the guide: a force against the velocity of the load."""

from pam_ros.effects.base import Compensation, Effect, EffectParameter, Row


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
    """Return f - c v, with c = q[j] in N s/m."""
    return f - q[j] * v


EFFECT = Effect(
    name='viscous_friction',
    text='viscous friction of the guide',
    source='Newtonian friction; the coefficient depends on the rig',
    parameters=(
        EffectParameter(
            'coefficient',
            0.0,
            'force per velocity',
            'N s/m',
            0.0,
            1e4,
            scale=50.0,
            strength=True,
            sign=1,
        ),
    ),
    signature='residual force proportional to velocity at every pressure and contraction',
    experiment='a chirp at two pressures: the decay is the same at both',
    fit_starts=({'coefficient': 30.0},),
    example={'coefficient': 30.0},
    compensation=Compensation.MODEL,
    rivals=('pressure_dependent_damping',),
    outside=outside,
    drag=outside,
)
