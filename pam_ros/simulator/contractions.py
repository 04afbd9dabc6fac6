# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which muscles contract further than they permit, and how far."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

# Contraction beyond kappa_max that is no event yet: for a muscle of 400 mm 2 mm, by which the zero
# of a contraction is uncertain where a muscle is mounted.
MARGIN = 0.005
# s without such a contraction after which an event is over: longer than the period of a load that
# swings about the limit, so that a swinging load is one event.
CALM = 1.0


class Excess(NamedTuple):
    """An event of a muscle, given by its number: its largest contraction so far."""

    muscle: int
    largest: float
    is_new: bool  # not reported before


@dataclass
class _Event:
    largest: float
    last: float  # simulated s at which the muscle was last beyond the limit
    is_new: bool = True


class Contractions:
    """Finds events of muscles that contract beyond their limits; ``count`` is how many."""

    def __init__(self) -> None:
        """Begin with no event."""
        self.count = 0
        self._events: dict[int, _Event] = {}

    def forget(self) -> None:
        """Forget the events, but not their count: simulated time begins again."""
        self._events.clear()

    def see_one(self, time: float, contraction: float, limit: float) -> None:
        """Note the contraction of a muscle alone at *time* in s, a fraction as its *limit* is."""
        if contraction - limit > MARGIN:
            self._note(time, 0, contraction)

    def see(
        self, time: float, contraction: NDArray[np.float64], limits: NDArray[np.float64]
    ) -> None:
        """Note the contractions (muscles,) at *time* in s, fractions as their *limits* are."""
        is_beyond = contraction - limits > MARGIN
        if is_beyond.any():
            for muscle in np.flatnonzero(is_beyond).tolist():
                self._note(time, muscle, float(contraction[muscle]))

    def _note(self, time: float, muscle: int, contraction: float) -> None:
        event = self._events.get(muscle)
        if event is None or time - event.last > CALM:
            self._events[muscle] = _Event(contraction, time)
            self.count += 1
        else:
            event.largest, event.last = max(event.largest, contraction), time

    def report(self, time: float) -> list[Excess]:
        """Return the events that go on at *time* in s, or began since the last call."""
        found = []
        for muscle, event in list(self._events.items()):
            is_over = time - event.last > CALM
            if event.is_new or not is_over:
                found.append(Excess(muscle, event.largest, event.is_new))
            event.is_new = False
            if is_over:
                del self._events[muscle]
        return found
