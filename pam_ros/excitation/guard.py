# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Monitor a joint while a programme runs: its position window and its state messages."""

import math


class Guard:
    """Detects when a programme must stop. Positions in m, times in s of one steady clock."""

    def __init__(self, low: float, high: float, silence: float, now: float) -> None:
        """Check for positions outside *low*..*high*, and for *silence* s without a position."""
        self._low, self._high, self._silence = low, high, silence
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
                f'the joint is at {1e3 * self.position:.1f} mm, outside its window of '
                f'{1e3 * self._low:.1f} to {1e3 * self._high:.1f} mm'
            )
        return ''
