# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Find interruptions of this process from the clock, and messages from before their end.

After a process was stopped, or its machine suspended, only the clock shows the interruption.
Messages that were sent during it are delivered after its end, and look like new ones.
"""

import time

from pam_ros.timing.delay import ShortestDelay
from pam_ros.timing.pace import SECOND

SETTLE = SECOND // 5  # ns of running after an interruption within which queued messages arrive
PATIENCE = 2 * SECOND  # ns of running after an interruption, then old stamps no longer count
# Most ns between two marks that count as running: in a longer time the process was delayed again.
TURN = SECOND // 10
DRIFT = 1000  # ns in which the clocks of two machines drift apart by less than 1 ns


def steady_ns() -> int:
    """Return ns of a clock that never jumps, and that also counts while the machine is suspended.

    On Linux CLOCK_MONOTONIC stops during a suspension; other systems have no CLOCK_BOOTTIME.
    """
    if hasattr(time, 'CLOCK_BOOTTIME'):
        return time.clock_gettime_ns(time.CLOCK_BOOTTIME)
    return time.monotonic_ns()


class Interruptions:
    """Finds interruptions of this process, and messages that were sent before their end.

    All times are ns of one clock that also counts during interruptions. Only stamps are times of
    the clock of the machine that measured.
    """

    def __init__(self, now: int) -> None:
        """Start at the time *now*, without an interruption."""
        self._marked = self._resumed = now
        self._ran = PATIENCE  # since the last interruption
        self._delays: dict[str, ShortestDelay] = {}  # of each source

    def mark(self, now: int) -> None:
        """Note that the work that began at *now* is done, with a command or without one.

        If an interruption was found since then, this call has no effect.
        """
        if now > self._marked:
            self._ran += min(now - self._marked, TURN)
            self._marked = now

    def find(self, now: int, longest: int) -> int:
        """Return the ns of interruption until *now* if they are more than *longest*, else 0."""
        length = now - self._marked
        if length <= longest:
            return 0
        self._marked = self._resumed = now
        self._ran = 0
        return length

    @property
    def is_settling(self) -> bool:
        """Whether messages that were queued during an interruption may still arrive."""
        return self._ran < SETTLE

    def is_old(self, source: str, stamp: int, now: int) -> bool:
        """Return whether a message of *source* may precede the end of the last interruption.

        *now* is its time of receipt. Until all queued messages have arrived, every message may be
        old. Later its *stamp* decides; a message without a stamp (0) is then new. The sum of the
        stamp and the shortest delay of this source, which includes the difference of the two
        clocks, is the time of the measurement.
        """
        if self.is_settling:
            return True
        if not stamp:
            return False
        delay = self._delays.setdefault(source, ShortestDelay(DRIFT))
        if self._ran < PATIENCE and now - delay.late(stamp, now) < self._resumed:
            return True
        delay.note(stamp, now)
        return False
