# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A fixed rate on a steady clock, and how well it is kept."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Punctuality:
    """How a rate was kept over *span* s: ticks, overruns so far, worst lateness in s."""

    span: float
    ticks: int
    overruns: int
    worst: float

    @property
    def rate(self) -> float:
        """Ticks a second."""
        return self.ticks / self.span


class Ticker:
    """Computes when the next tick is due; due times are counted from a start, never summed.

    Times are nanoseconds of a steady clock. A tick that comes a whole period late or more is an
    overrun; the ticks that are missed with it are skipped.
    """

    def __init__(self, rate: float) -> None:
        """Create it for a *rate* in Hz; :meth:`start` starts the ticks."""
        self.overruns = 0
        self.start(rate, 0)

    def start(self, rate: float, now: int) -> None:
        """Tick at *rate* from *now* on; the first tick is due at once."""
        self.rate = rate
        self._period = 1e9 / rate
        self._start, self._due, self._n = now, now, 0
        self._since, self._ticks, self._worst = now, 0, 0

    def remaining(self, now: int) -> float:
        """Return the seconds until the next tick, 0 or less when it is due."""
        return (self._due - now) * 1e-9

    def aim(self, due: int) -> None:
        """Move all future ticks, so that the next one is due at *due*."""
        self._start += due - self._due
        self._due = due

    def tick(self, now: int) -> None:
        """Count the tick that is due and set the next one."""
        late = now - self._due
        self._worst = max(self._worst, late)
        self._ticks += 1
        self._n += 1
        if late >= self._period:
            self._n += int(late // self._period)
            self.overruns += 1
        self._due = self._start + round(self._n * self._period)

    def report(self, now: int) -> Punctuality:
        """Return how the rate was kept since the last report."""
        span = max(now - self._since, 1) * 1e-9
        kept = Punctuality(span, self._ticks, self.overruns, self._worst * 1e-9)
        self._since, self._ticks, self._worst = now, 0, 0
        return kept
