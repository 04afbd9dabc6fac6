# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A pressure that is a smooth function of time, fed to the kernel through an effect of its own.

Commands are held between stamps; this is how the order of the integrator can be seen.
"""

from dataclasses import dataclass
from math import sin
from typing import ClassVar

from pam_ros.effects.base import Compensation, Effect, EffectEquations
from pam_ros.effects.parameter import effect_parameter, strength

MEAN, AMPLITUDE, RATE = 350e3, 200e3, 5.0  # Pa, Pa, rad/s


def pressure(p, t, h, x, i, xn, q, j):
    """Return the pressure at t, whatever is commanded."""
    return q[j] + q[j + 1] * sin(q[j + 2] * t)


def at(t):
    """Return the same in bar, for the paper's equations."""
    return (MEAN + AMPLITUDE * sin(RATE * t)) / 1e5


@dataclass(frozen=True)
class SmoothSupply(Effect):
    """A pressure that swings."""

    mean: float = strength('mean', high=1e6, scale=1.0)
    amplitude: float = effect_parameter(AMPLITUDE, 'amplitude', low=-1e6, high=1e6, scale=1.0)
    rate: float = effect_parameter(RATE, 'rate', low=-1e6, high=1e6, scale=1.0)

    name: ClassVar = 'smooth_supply'
    text: ClassVar = 'a pressure that swings'
    source: ClassVar = 'none: a test'
    signature: ClassVar = ''
    experiment: ClassVar = ''
    compensation: ClassVar = Compensation.FEEDBACK
    equations: ClassVar = EffectEquations(pressure=pressure)

    @classmethod
    def fit_starts(cls):
        """Return none."""
        return ()

    @classmethod
    def example(cls):
        """Return it clearly present."""
        return cls(mean=MEAN)
