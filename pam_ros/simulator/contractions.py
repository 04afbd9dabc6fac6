# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Detect muscles that contract beyond their permitted contraction, and by how much."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

# Contraction beyond kappa_max that is not yet an event. For a muscle of 400 mm this is 2 mm, the
# uncertainty of the zero of the contraction when a muscle is mounted.
MARGIN = 0.005
# s without such a contraction after which an event is over. It is longer than the period of a load
# that oscillates about the limit, so that an oscillating load is one event.
CALM = 1.0


class Excess(NamedTuple):
    """An event: the number of the muscle, and its largest contraction so far."""

    muscle: int
    largest: float
    is_new: bool  # not reported before


@dataclass
class _Event:
    largest: float
    last: float  # simulated s at which the muscle was last beyond the limit
    is_new: bool = True


class Contractions:
    """Finds events of muscles that contract beyond their limits; ``count`` is their number."""

    def __init__(self) -> None:
        """Start without events."""
        self.count = 0
        self._events: dict[int, _Event] = {}

    def forget(self) -> None:
        """Forget the events, but not their count: simulated time starts again."""
        self._events.clear()

    def record(self, time: float, contractions: Sequence[float], limits: Sequence[float]) -> None:
        """Record the contractions of all muscles and their *limits*, fractions, at *time* in s."""
        for muscle, (contraction, limit) in enumerate(zip(contractions, limits, strict=True)):
            if contraction - limit > MARGIN:
                self._note(time, muscle, contraction)

    def _note(self, time: float, muscle: int, contraction: float) -> None:
        event = self._events.get(muscle)
        if event is None or time - event.last > CALM:
            self._events[muscle] = _Event(contraction, time)
            self.count += 1
        else:
            event.largest, event.last = max(event.largest, contraction), time

    def report(self, time: float) -> list[Excess]:
        """Return the events that continue at *time* in s, or began since the last call."""
        found = []
        for muscle, event in list(self._events.items()):
            is_over = time - event.last > CALM
            if event.is_new or not is_over:
                found.append(Excess(muscle, event.largest, event.is_new))
            event.is_new = False
            if is_over:
                del self._events[muscle]
        return found
