# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Payload: the moved mass is not the declared one."""

from pam_ros.effects.base import Compensation, Effect, EffectParameter, Row

# A load can be overestimated, but never be nothing: other effects rely on the declared mass.
LEAST_SHARE = 0.2


def mass(m: float, q: Row, j: int) -> float:
    """Return m + q[j], both in kg, at least a fifth of m."""
    return max(m + q[j], LEAST_SHARE * m)


EFFECT = Effect(
    name='payload',
    text='mass of the load beside the declared one',
    source='Newton: weight and inertia alike',
    parameters=(
        EffectParameter(
            'mass',
            0.0,
            'mass that comes on top, negative when the load is lighter',
            'kg',
            -1e3,
            1e3,
            scale=2.0,
            strength=True,
        ),
    ),
    signature='constant residual force, and inertia: a slower oscillation',
    experiment='steps that make the load swing, or a force cell, or the load on a balance',
    fit_starts=({'mass': 1.0}, {'mass': -1.0}),
    example={'mass': 1.5},
    compensation=Compensation.MODEL,
    rivals=('pressure_offset', 'length_offset'),
    mass=mass,
)
