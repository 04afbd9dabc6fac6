# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The work of an identification: which step is running, and how long the rest will take.

Nearly all of the time is spent in simulations. Their cost is proportional to the number of time
steps of the integrator, so that work is counted in such steps, of all runs and all threads. The
time that is left follows from the steps that are expected and from the rate at which they are
made, which is measured.
"""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Lock
from typing import NamedTuple, TypeVar

Progress = Callable[[float, str], object]  # share of the work that is done, and the next step
TimeLeft = Callable[[float, float], object]  # s that the rest takes at least, and at most
Stop = Callable[[], bool]
T = TypeVar('T')
# s in which the rate of simulations is replaced by that of the last ones: models with more effects
# are slower.
MEMORY = 20.0
# s, longest pause between two simulations that counts as time of the work: a program that was
# stopped for hours, or a computer that slept, has not become slower.
LONGEST_PAUSE = 10.0
UPDATE = 1.0  # s between reports within a step
OVERDUE = 0.2  # share of what a step has taken beyond its forecast that is expected to follow


class Forecast(NamedTuple):
    """Time steps of simulations that will be made: probably at least ``low``, at most ``high``."""

    low: float
    high: float

    def plus(self, other: 'Forecast') -> 'Forecast':
        """Return the forecast of both."""
        return Forecast(self.low + other.low, self.high + other.high)

    def times(self, factor: float) -> 'Forecast':
        """Return the forecast of so many times this work."""
        return Forecast(factor * self.low, factor * self.high)


NOTHING = Forecast(0.0, 0.0)


class _StoppedError(Exception):
    """The user has asked for the end of a search: it ends the fits that are running."""


class Work:
    """What has been simulated, which step is running, and what is expected to follow.

    progress(share, text) is called with each step and about once a second within it, and before it
    time_left(low, high) with the s that the rest will take, as soon as this is known. The *clock*
    gives times in s.

    A search consists of attempts to improve its model. If *stop* returns true during one of them,
    at any simulation, this attempt is given up, and no other one is made: ``is_stopped``.
    """

    def __init__(
        self,
        progress: Progress | None = None,
        time_left: TimeLeft | None = None,
        stop: Stop | None = None,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        """Begin with nothing done and nothing known of what follows."""
        self._progress: Progress = progress or (lambda share, text: None)
        self._time_left: TimeLeft = time_left or (lambda low, high: None)
        self._stop: Stop = stop or (lambda: False)
        self._clock = clock
        self._lock = Lock()
        self._seen = self._reported = clock()
        self._elapsed = self._done = 0.0
        self._text, self._share = '', 0.0
        # Time steps per s, None before they are known, and elapsed and done at their last change.
        self._rate: float | None = None
        self._before = (0.0, 0.0)
        self._forecast, self._done_before = NOTHING, 0.0
        self._parts: list[tuple[str, Forecast]] = []
        self._attempts = 0  # that are running, one within the other
        self.is_stopped = False

    def simulated(self, steps: float) -> None:
        """Count a simulation with so many time steps; any thread may call this.

        Raises an exception that :meth:`attempt` handles if the attempt must end.
        """
        if self._attempts and self._stop():
            raise _StoppedError
        with self._lock:
            self._done += steps
            self._note_time()

    @property
    def done(self) -> float:
        """The number of time steps that were simulated so far."""
        return self._done

    def attempt(self, move: Callable[[], T]) -> T | None:
        """Return move(), None if it is stopped or if an earlier attempt was.

        Nothing of the attempt continues in other threads, see :class:`.workers.Workers`.
        """
        if self.is_stopped:
            return None
        self._attempts += 1
        try:
            return move()
        except _StoppedError:
            self.is_stopped = True
            self.step('the search was stopped')
            return None
        finally:
            self._attempts -= 1

    def begin_search(self, rate: float) -> None:
        """State the *rate* in time steps per s that simulations of a search will probably have.

        It is replaced by the measured one little by little. *stop* is asked here for the first
        time, since there is now a model to report.
        """
        self._stop()
        with self._lock:
            self._note_time()
            self._rate, self._before = rate, (self._elapsed, self._done)

    def step(self, text: str, rest: Forecast | None = None) -> None:
        """Begin a step, and state the *rest*, which is the work of this step and what follows it.

        Without *rest* the last forecast remains.
        """
        self._text = ': '.join(filter(None, [*(name for name, _ in self._parts), text]))
        if rest is not None:
            for _, later in self._parts:
                rest = rest.plus(later)
            self._forecast, self._done_before = rest, self._done
        self._report()

    @contextmanager
    def part(self, name: str, later: Forecast = NOTHING) -> Iterator[None]:
        """Do a part of the work, called *name*; *later* is the work that follows it."""
        self._parts.append((name, later))
        try:
            yield
        finally:
            self._parts.pop()

    def update(self) -> None:
        """Report the time that is left, if the last report is old enough."""
        if self._clock() - self._reported >= UPDATE:
            self._report()

    def end(self) -> None:
        """Report that all is done."""
        self._share, self._text = 1.0, 'done'
        self._progress(1.0, self._text)

    def left(self) -> tuple[float, float] | None:
        """Return the s that the rest takes at least and at most, None if they are not known."""
        with self._lock:
            self._note_time()
            if self._rate is None:
                return None
            elapsed, done = self._elapsed - self._before[0], self._done - self._before[1]
            rate = (MEMORY * self._rate + done) / (MEMORY + elapsed)
            self._rate, self._before = rate, (self._elapsed, self._done)
            since = self._done - self._done_before
        low, high = self._forecast
        over = OVERDUE * max(since - high, 0.0)
        return max(low - since, over) / rate, max(high - since, over) / rate

    def _report(self) -> None:
        self._reported = self._clock()
        left = self.left()
        if left is not None:
            low, high = left
            middle = 0.5 * (low + high)
            share = self._elapsed / max(self._elapsed + middle, 1e-9)
            self._share = max(self._share, min(share, 0.99))
            self._time_left(low, high)
        self._progress(self._share, self._text)

    def _note_time(self) -> None:
        now = self._clock()
        self._elapsed += min(now - self._seen, LONGEST_PAUSE)
        self._seen = now
