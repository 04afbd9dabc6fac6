# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Monitor a joint while a programme runs: its position window and its state messages."""

import math


class Guard:
    """Detects when a programme must stop. Positions in m or rad, times in s of a steady clock."""

    def __init__(self, low: float, high: float, unit: str, silence: float, now: float) -> None:
        """Check for positions outside *low*..*high*, and for *silence* s without a position."""
        self._low, self._high, self._unit, self._silence = low, high, unit, silence
        self._seen = now
        self.position: float | None = None

    def record(self, position: float, now: float) -> None:
        """Record the position of the joint at the time *now*."""
        self.position, self._seen = position, now

    def problem(self, now: float) -> str:
        """Return the reason to stop as a sentence, or ''."""
        if now - self._seen > self._silence:
            return f'no joint_states for {now - self._seen:.2f} s'
        if self.position is None:
            return ''
        if not math.isfinite(self.position):
            return f'the position of the joint is {self.position}'
        if not self._low <= self.position <= self._high:
            return (
                f'the joint is at {spelled(self.position, unit=self._unit)}, outside its window '
                f'of {spelled(self._low, self._high, unit=self._unit)}'
            )
        return ''


def spelled(*positions: float, unit: str) -> str:
    """Return a position, or a range of positions, for people: m as mm, rad with 3 decimals."""
    if unit == 'm':
        return ' to '.join(f'{1e3 * position:.1f}' for position in positions) + ' mm'
    return ' to '.join(f'{position:.3f}' for position in positions) + f' {unit}'
