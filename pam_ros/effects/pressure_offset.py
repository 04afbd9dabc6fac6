# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pressure offset: the regulator or sensor has an offset and a gain error."""

from dataclasses import dataclass
from typing import ClassVar

from pam_ros.effects.base import Compensation, Effect, EffectEquations, Row, Starts
from pam_ros.effects.parameter import start_from, strength

OFFSET, GAIN = range(2)


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return p with the gain error and the offset."""
    return p + (q[j + OFFSET] + q[j + GAIN] * p)


@dataclass(frozen=True)
class PressureOffset(Effect):
    """Offset and gain error of the pressure regulator or sensor."""

    offset: float = strength(
        'pressure in the chamber at a command of 0', 'Pa', low=-2e5, high=2e5, scale=1e4
    )
    gain: float = strength('relative error of the pressure', low=-0.5, high=0.5, scale=0.05)

    name: ClassVar = 'pressure_offset'
    text: ClassVar = 'offset and gain error of the pressure regulator or sensor'
    source: ClassVar = 'Affine sensor model'
    equation: ClassVar = 'p = (1 + gain) p_in + offset'
    signature: ClassVar = 'residual proportional to dF/dp, to p dF/dp for the gain'
    experiment: ClassVar = 'the force over the pressure at two constant lengths'
    compensation: ClassVar = Compensation.PATH
    rivals: ClassVar = ('payload', 'length_offset', 'leak', 'dead_band')
    equations: ClassVar = EffectEquations(pressure=pressure)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, offset=5e3),
            start_from(cls, offset=-5e3),
            start_from(cls, offset=1e3, gain=0.03),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(offset=6e3, gain=-0.03)
