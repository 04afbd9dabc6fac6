# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Dead time: the pressure responds to a command only after a delay."""

from dataclasses import dataclass
from typing import ClassVar

from pam_ros.effects.base import Compensation, Effect, EffectEquations, Row, Starts
from pam_ros.effects.parameter import start_from, strength

DELAY = 0


def late(q: Row, j: int) -> float:
    """Return the delay in s."""
    return q[j + DELAY]


@dataclass(frozen=True)
class DeadTime(Effect):
    """Transport delay between command and pressure."""

    delay: float = strength('delay of the commands', 's', high=1.0, scale=0.01)

    name: ClassVar = 'dead_time'
    text: ClassVar = 'transport delay between command and pressure'
    source: ClassVar = 'Wave travel in the tube, switching time of the valve, computing time'
    equation: ClassVar = 'p(t) = u(t - delay), with the command u'
    signature: ClassVar = (
        'phase that falls in proportion to frequency; nothing moves after a step for a time'
    )
    experiment: ClassVar = (
        'steps recorded at 500 Hz or more, or a chirp up to the corner of the lag'
    )
    excitation: ClassVar = {'segments': ('steps', 'chirps'), 'rate': 500.0, 'frequency_max': 20.0}
    compensation: ClassVar = Compensation.PATH
    rivals: ClassVar = ('pressure_lag',)
    equations: ClassVar = EffectEquations(delay=late)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, delay=0.005),
            start_from(cls, delay=0.02),
            start_from(cls, delay=0.05),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(delay=0.0153)
