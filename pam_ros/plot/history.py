# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The last seconds of a rig, thinned on arrival to the resolution of a plot."""

from collections import deque
from threading import Lock

import numpy as np

from pam_ros.plot.panels import Curves
from pam_ros.plot.topics import Key

COLUMNS = 600  # of time; a curve keeps its least and its greatest value in each of them


class History:
    """The curves of the last ``span`` seconds.

    At most two samples of each curve are kept in each of 600 columns of time, for any rate and
    any span. One thread may add samples while another reads them.
    """

    def __init__(self, span: float) -> None:
        """Start without a sample; *span* is in s."""
        self.span = span
        self._width = span / COLUMNS
        self._traces: dict[Key, _Trace] = {}
        self._muscles: tuple[str, ...] = ()
        self._lock = Lock()

    def add(self, key: Key, t: float, value: float) -> None:
        """Add a sample at *t* s. One that is not finite is ignored."""
        if not np.isfinite(value):
            return
        with self._lock:
            trace = self._traces.get(key)
            if trace is None:
                trace = self._traces[key] = _Trace(self._width)
            trace.add(t, value)

    def name_muscles(self, names: tuple[str, ...]) -> None:
        """Store the names of the muscles; an empty tuple changes nothing."""
        self._muscles = names or self._muscles

    def clear(self) -> None:
        """Remove all samples, because time has gone back."""
        with self._lock:
            self._traces.clear()

    def curves(self, end: float) -> Curves:
        """Return the samples of the last ``span`` s before *end* s; empty curves are left out."""
        with self._lock:
            found = {}
            for key, trace in self._traces.items():
                trace.forget(end - self.span)
                if points := trace.points():
                    t, value = np.array(points).T
                    found[key] = (t, value)
        return Curves(found, self._muscles)


class _Trace:
    """One curve: the least and the greatest value in each column of time, in the order of time."""

    def __init__(self, width: float) -> None:
        self._width = width
        self._points: deque[tuple[float, float]] = deque()
        self._column: int | None = None
        self._low = self._high = (0.0, 0.0)

    def add(self, t: float, value: float) -> None:
        """Add a sample."""
        column = int(t // self._width)
        if column != self._column:
            self._points.extend(self._of_column())
            self._column, self._low, self._high = column, (t, value), (t, value)
        elif value < self._low[1]:
            self._low = (t, value)
        elif value > self._high[1]:
            self._high = (t, value)

    def _of_column(self) -> list[tuple[float, float]]:
        return [] if self._column is None else sorted({self._low, self._high})

    def forget(self, before: float) -> None:
        """Remove the samples before *before* s, except the last of them.

        The line to the edge of the plot starts there, and a reference is constant until the next.
        """
        while len(self._points) > 1 and self._points[1][0] < before:
            self._points.popleft()

    def points(self) -> list[tuple[float, float]]:
        """Return the samples that are kept, in the order of time."""
        return [*self._points, *self._of_column()]
