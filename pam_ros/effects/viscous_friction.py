# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Viscous friction of the guide: a force against the velocity of the load."""

from dataclasses import dataclass
from typing import ClassVar

from pam_ros.effects.base import Compensation, Effect, EffectEquations, Row, Starts
from pam_ros.effects.parameter import start_from, strength

COEFFICIENT = 0


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
    """Return f - c v, with the coefficient c."""
    return f - q[j + COEFFICIENT] * v


@dataclass(frozen=True)
class ViscousFriction(Effect):
    """Viscous friction of the guide."""

    coefficient: float = strength('force per velocity', 'N s/m', high=1e4, scale=50.0)

    name: ClassVar = 'viscous_friction'
    text: ClassVar = 'viscous friction of the guide'
    source: ClassVar = 'Newtonian friction; the coefficient depends on the rig'
    equation: ClassVar = 'F = F_in - coefficient v'
    signature: ClassVar = (
        'residual force proportional to velocity at every pressure and contraction'
    )
    experiment: ClassVar = 'a chirp at two pressures: the decay is the same at both'
    excitation: ClassVar = {'segments': ('chirps',)}
    compensation: ClassVar = Compensation.MODEL
    rivals: ClassVar = ('pressure_dependent_damping',)
    equations: ClassVar = EffectEquations(outside=outside, drag=outside)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (start_from(cls, coefficient=30.0),)

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(coefficient=30.0)
