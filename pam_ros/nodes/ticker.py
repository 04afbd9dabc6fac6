# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A fixed rate on a steady clock, and how well it is kept."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Punctuality:
    """How a rate was kept over a while: Hz, overruns so far, worst lateness in s."""

    rate: float
    overruns: int
    worst: float


class Ticker:
    """Says when the next tick is due; due times are counted from a start, never summed.

    Times are nanoseconds of a steady clock. A tick that comes a whole period late or more is an
    overrun; the ticks missed with it are not made up for.
    """

    def __init__(self, rate: float, now: int) -> None:
        """Begin at *now* with a *rate* in Hz; the first tick is due at once."""
        self.overruns = 0
        self._since, self._ticks, self._worst = now, 0, 0
        self.restart(rate, now)

    def restart(self, rate: float, now: int) -> None:
        """Go on with another rate from *now*."""
        self._period = 1e9 / rate
        self._start, self._due = now, now
        self._n = 0

    def remaining(self, now: int) -> float:
        """Return the seconds until the next tick, 0 or less when it is due."""
        return (self._due - now) * 1e-9

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
        rate = self._ticks * 1e9 / max(now - self._since, 1)
        kept = Punctuality(rate, self.overruns, self._worst * 1e-9)
        self._since, self._ticks, self._worst = now, 0, 0
        return kept
