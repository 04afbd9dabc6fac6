# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Length offset: the muscle's rest length is not the declared one."""

from pam_ros.effects.base import Compensation, Effect, EffectParameter, Row


def contraction(kappa: float, q: Row, j: int) -> float:
    """Return kappa + offset, with the offset q[j] as a fraction of l0."""
    return kappa + q[j]


EFFECT = Effect(
    name='length_offset',
    text='contraction that the muscle feels beside the one that is measured',
    source='Rest length and clamping differ between specimens; affine sensor model',
    parameters=(
        EffectParameter(
            'offset',
            0.0,
            'contraction at which the declared rest length really is',
            'fraction',
            -0.3,
            0.3,
            scale=0.02,
            strength=True,
        ),
    ),
    signature='residual proportional to the stiffness: the whole curve moved along contraction',
    experiment='static points over the whole range at two pressures, or the rest length measured',
    fit_starts=({'offset': 0.02}, {'offset': -0.02}),
    example={'offset': 0.015},
    compensation=Compensation.MODEL,
    rivals=('pressure_offset', 'payload'),
    contraction=contraction,
    needs_muscle=True,
)
