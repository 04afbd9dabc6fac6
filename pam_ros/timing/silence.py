# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Find silences that a process cannot notice itself, and messages from before their end.

A process that is stopped, or whose machine sleeps, only notices that the clock has advanced.
Messages from the time of this silence are delivered after its end, and look like new ones.
"""

import time

from pam_ros.timing.pace import SECOND

SETTLE = SECOND // 5  # ns of running after a silence within which queued messages arrive
PATIENCE = 2 * SECOND  # ns of running after a silence after which old stamps no longer count
TURN = SECOND // 10  # most ns of running between two marks: if longer, it was delayed again
DRIFT = 1000  # ns in which the clocks of two machines drift apart by less than 1 ns


def steady_ns() -> int:
    """Return ns of a clock that never jumps, and that also counts while the machine sleeps.

    On Linux CLOCK_MONOTONIC stops during a suspension; other systems have no CLOCK_BOOTTIME.
    """
    if hasattr(time, 'CLOCK_BOOTTIME'):
        return time.clock_gettime_ns(time.CLOCK_BOOTTIME)
    return time.monotonic_ns()


class Silence:
    """Finds silences of this process, and separates messages from before their end from new ones.

    All times are ns of one clock that also counts during silences. Only stamps are times of the
    clock of the machine that measured.
    """

    def __init__(self, now: int) -> None:
        """Start at the time *now*, without a silence."""
        self._alive = self._woke = now
        self._ran = PATIENCE  # since the last silence
        self._shortest: dict[str, tuple[int, int]] = {}  # shortest delay of each, and its time

    def mark(self, now: int) -> None:
        """Note that the work that began at *now* is done, with a command or without one.

        If the process was stopped since then and a silence was found, this call has no effect.
        """
        if now > self._alive:
            self._ran += min(now - self._alive, TURN)
            self._alive = now

    def find(self, now: int, longest: int) -> int:
        """Return the length of the silence until *now* if it is more than *longest*, else 0."""
        silent = now - self._alive
        if silent <= longest:
            return 0
        self._alive = self._woke = now
        self._ran = 0
        return silent

    @property
    def is_settling(self) -> bool:
        """Whether messages that were queued during a silence may still arrive."""
        return self._ran < SETTLE

    def is_old(self, source: str, stamp: int, now: int) -> bool:
        """Return whether a message of *source* may have been sent before the last silence ended.

        *now* is its time of receipt. Until all queued messages have arrived, every message may be
        old. Later its *stamp* decides; a message without a stamp (0) is then new. The sum of the
        stamp and the shortest delay of this source, which includes the difference of the two
        clocks, is the time of the measurement.
        """
        if self.is_settling:
            return True
        if not stamp:
            return False
        delay = now - stamp
        if source in self._shortest:
            shortest, noted = self._shortest[source]
            shortest += (now - noted) // DRIFT
            if self._ran < PATIENCE and stamp + shortest < self._woke:
                return True
            delay = min(delay, shortest)
        self._shortest[source] = delay, now
        return False
