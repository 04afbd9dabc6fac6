# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Length offset: the muscle's rest length is not the nominal one."""

from dataclasses import dataclass
from typing import ClassVar

from pam_ros.effects.base import Compensation, Effect, EffectEquations, Row, Starts
from pam_ros.effects.parameter import start_from, strength

OFFSET = 0


def contraction(kappa: float, q: Row, j: int) -> float:
    """Return kappa + offset."""
    return kappa + q[j + OFFSET]


@dataclass(frozen=True)
class LengthOffset(Effect):
    """Difference between the effective contraction of the muscle and the measured one."""

    offset: float = strength(
        'contraction that the muscle really has at the nominal rest length',
        'fraction',
        low=-0.3,
        high=0.3,
        scale=0.02,
    )

    name: ClassVar = 'length_offset'
    text: ClassVar = 'constant difference between the effective and the measured contraction'
    source: ClassVar = 'Rest length and clamping differ between specimens; affine sensor model'
    equation: ClassVar = 'κ = κ_measured + offset'
    signature: ClassVar = (
        'residual proportional to the stiffness: the whole curve moved along contraction'
    )
    experiment: ClassVar = (
        'static points over the whole range with two loads, or the rest length measured'
    )
    excitation: ClassVar = {'segments': ('steps',)}
    compensation: ClassVar = Compensation.MODEL
    rivals: ClassVar = ('pressure_offset', 'payload')
    needs_muscle: ClassVar = True
    equations: ClassVar = EffectEquations(contraction=contraction)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, offset=0.02),
            start_from(cls, offset=-0.02),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(offset=0.015)
