# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Check pressure commands as a rig's valve would: never out of its limits, never a NaN."""

import math


class PressureInput:
    """Takes commands in Pa gauge, and remembers how many were bad and why.

    A value outside 0..p_max is clamped, as a valve that is fully open or closed does. A value
    that is no number is refused: the last good command stays in force.
    """

    def __init__(self, p_max: float) -> None:
        """Begin with the limit *p_max* in Pa and no command."""
        self.p_max = p_max
        self.accepted = 0
        self.clamped = 0
        self.refused = 0
        self.reason = ''
        self.last: float | None = None  # Pa, the last good command as it came

    def take(self, value: float) -> float | None:
        """Return the pressure to apply in Pa, or None where *value* is refused."""
        if not math.isfinite(value):
            self.refused += 1
            self.reason = f'pressure command {value} is no number: the last good one holds'
            return None
        self.accepted += 1
        self.last = value
        applied = min(max(value, 0.0), self.p_max)
        if applied != value:
            self.clamped += 1
            self.reason = f'pressure command {value:g} Pa is outside 0 to {self.p_max:g}: clamped'
        return applied
