# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Damping that grows with pressure, separately for inflating and deflating."""

from dataclasses import dataclass
from typing import ClassVar

from pam_ros.effects.base import Compensation, Effect, EffectEquations, Row, Starts
from pam_ros.effects.parameter import start_from, strength

INFLATING, DEFLATING = range(2)


def damping(c: float, p: float, kappa: float, v: float, q: Row, j: int) -> float:
    """Return c + b p, with b = inflating while the muscle shortens, and deflating otherwise.

    c jumps at v = 0, but the force c v is 0 there and stays continuous.
    """
    if q[j + INFLATING] == 0.0 and q[j + DEFLATING] == 0.0:
        return c
    return c + (q[j + INFLATING] if v > 0.0 else q[j + DEFLATING]) * max(p, 0.0)


@dataclass(frozen=True)
class PressureDependentDamping(Effect):
    """Damping proportional to pressure, separately for inflating and deflating."""

    inflating: float = strength(
        'damping per pressure while the muscle shortens', 'N s/(m Pa)', high=0.1, scale=3e-4
    )
    deflating: float = strength(
        'damping per pressure while the muscle lengthens', 'N s/(m Pa)', high=0.1, scale=3e-4
    )

    name: ClassVar = 'pressure_dependent_damping'
    text: ClassVar = 'damping proportional to pressure, separate for inflation and deflation'
    source: ClassVar = 'Reynolds et al. 2003; Serres et al. 2009'
    equation: ClassVar = (
        'c = c_in + inflating p  while the muscle shortens\n'
        'c = c_in + deflating p  while it lengthens'
    )
    signature: ClassVar = 'residual over velocity whose slope grows with pressure'
    experiment: ClassVar = 'a chirp at several pressures: the decay is faster at the higher one'
    excitation: ClassVar = {'segments': ('chirps',)}
    compensation: ClassVar = Compensation.MODEL
    rivals: ClassVar = ('viscous_friction', 'creep')
    needs_muscle: ClassVar = True
    equations: ClassVar = EffectEquations(damping=damping)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, inflating=1e-4, deflating=1e-4),
            start_from(cls, inflating=6e-4, deflating=6e-4),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(inflating=3e-4, deflating=1e-4)
