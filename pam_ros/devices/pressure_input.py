# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Check pressure commands like the valve of a rig: within its limits, and never NaN."""

import math

from pam_ros.muscle.muscle import Muscle
from pam_ros.muscle.pressure_unit import is_low


class PressureInput:
    """Accepts commands in Pa gauge, counts the bad ones, and keeps the reason of the last one.

    A value outside p_min..p_max is clamped, as by a valve that is fully open or closed. A value
    that is not finite is refused: the last valid command remains active.
    """

    def __init__(self, muscle: Muscle) -> None:
        """Start with the limits of *muscle* and without a command."""
        self.muscle = muscle
        self.accepted = 0
        self.clamped = 0
        self.refused = 0
        self.reason = ''
        self.last: float | None = None  # Pa, the last valid command before clamping
        self.highest = 0.0  # Pa, the largest absolute value of them

    def take(self, value: float) -> float | None:
        """Return the pressure to apply in Pa, or None if *value* is refused."""
        if not math.isfinite(value):
            self.refused += 1
            self.reason = (
                f'pressure command {value} is not finite: the last valid one remains active'
            )
            return None
        self.accepted += 1
        self.last = value
        self.highest = max(self.highest, abs(value))
        applied = self.within_limits(value)
        if applied != value:
            self.clamped += 1
            limits = f'{self.muscle.p_min:g} to {self.muscle.p_max:g}'
            self.reason = f'pressure command {value:g} Pa is outside {limits}: clamped'
        return applied

    @property
    def is_low(self) -> bool:
        """Whether all commands were so low that they may be in kPa or bar."""
        return is_low(self.highest, self.muscle.p_max)

    def within_limits(self, pressure: float) -> float:
        """Return the pressure in Pa, possible for the valve, that is nearest to *pressure*."""
        return min(max(pressure, self.muscle.p_min), self.muscle.p_max)
