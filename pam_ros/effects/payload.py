# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Payload: the moved mass is not the nominal one."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from pam_ros.effects.base import Compensation, Effect, EffectEquations, Interval, Row, Starts
from pam_ros.effects.parameter import start_from, strength
from pam_ros.errors import ParameterError

MASS = 0

# The true mass can be below the nominal one. Down to this share other effects, which use the
# nominal inertia, stay stable.
LEAST_SHARE = 0.2


def moved(m: float, q: Row, j: int) -> float:
    """Return the mass m plus the additional mass, at least a fifth of m."""
    return max(m + q[j + MASS], LEAST_SHARE * m)


@dataclass(frozen=True)
class Payload(Effect):
    """Mass of the load in addition to the nominal one."""

    mass: float = strength(
        'additional mass of the load; negative: the load is lighter',
        'kg',
        low=-1e3,
        high=1e3,
        scale=2.0,
    )

    name: ClassVar = 'payload'
    text: ClassVar = 'mass of the load in addition to the nominal one'
    source: ClassVar = 'Newton: weight and inertia alike'
    equation: ClassVar = 'm = max(m_in + mass, m_in / 5)'
    signature: ClassVar = 'constant residual force, and inertia: a slower oscillation'
    experiment: ClassVar = (
        'steps that make the load swing, or a force cell, or the load on a balance'
    )
    excitation: ClassVar = {'segments': ('steps', 'chirps')}
    compensation: ClassVar = Compensation.MODEL
    rivals: ClassVar = ('pressure_offset', 'length_offset')
    equations: ClassVar = EffectEquations(mass=moved)

    def check(self, *, mass: float, revolute: bool) -> None:
        """Raise ParameterError if it leaves the joint less than a fifth of its *mass* in kg.

        The equations keep a fifth for any payload, since fits may change the mass as well.
        """
        super().check(mass=mass, revolute=revolute)
        least = (LEAST_SHARE - 1.0) * mass
        if self.mass < least:
            raise ParameterError(
                f'effects.payload.mass = {self.mass:g} kg leaves {mass + self.mass:g} kg of '
                f'mass = {mass:g} kg: give at least {least:g} kg'
            )

    @classmethod
    def fit_bounds(
        cls, near: Mapping[str, float], fitted: Collection[str], mass: float, duration: float
    ) -> dict[str, Interval]:
        """Return the bounds of its mass that leave the joint a fifth of the nominal one."""
        return {'mass': ((LEAST_SHARE - 1.0) * mass, np.inf)}

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, mass=1.0),
            start_from(cls, mass=-1.0),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(mass=1.5)
