# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How long a process was silent without knowing it, and which messages are older than that.

A process that is stopped, or whose machine sleeps, sees nothing of it but a clock that has gone
on. What was measured meanwhile is delivered when it wakes, and looks as if it were of now.
"""

import time

from pam_ros.timing.pace import SECOND

SETTLE = SECOND // 5  # ns of running after waking in which what was queued arrives
PATIENCE = 2 * SECOND  # ns of running after which stamps that never become new are not believed
TURN = SECOND // 10  # longest ns of one turn that count as running: else it was held up again
DRIFT = 1000  # ns in which the clocks of two machines part by less than 1 ns


def steady_ns() -> int:
    """Return ns of a clock that never jumps, and that also counts while the machine sleeps.

    Linux stops CLOCK_MONOTONIC during a suspension; other systems have no CLOCK_BOOTTIME.
    """
    if hasattr(time, 'CLOCK_BOOTTIME'):
        return time.clock_gettime_ns(time.CLOCK_BOOTTIME)
    return time.monotonic_ns()


class Silence:
    """Finds silences of this process, and tells messages from before its waking from new ones.

    All times are ns of one clock that counts during silences, but for stamps, which are of the
    clock of whoever measured.
    """

    def __init__(self, now: int) -> None:
        """Begin now, with nothing that is old."""
        self._alive = self._woke = now
        self._ran = PATIENCE  # since it woke
        self._shortest: dict[str, tuple[int, int]] = {}  # delay of each source, and when noted

    def mark(self, now: int) -> None:
        """Note that its work of *now* is done: it has commanded, or has nothing to command.

        *now* is when that work began. If it was stopped in between, a silence found since counts.
        """
        if now > self._alive:
            self._ran += min(now - self._alive, TURN)
            self._alive = now

    def find(self, now: int, longest: int) -> int:
        """Return how long it has been silent if that is more than *longest*, else 0."""
        silent = now - self._alive
        if silent <= longest:
            return 0
        self._alive = self._woke = now
        self._ran = 0
        return silent

    @property
    def is_settling(self) -> bool:
        """Whether what was queued in a silence may still arrive."""
        return self._ran < SETTLE

    def is_old(self, source: str, stamp: int, now: int) -> bool:
        """Say whether a message of *source* that is received now may be from before the waking.

        Until all that was queued has arrived, every message may be. After that its *stamp* tells,
        0 where there is none: added to the shortest delay of this source, which includes the
        difference of the two clocks, it is the time at which it was measured.
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
