# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The last seconds of a rig, thinned on arrival to a resolution finer than that of a plot."""

from array import array
from bisect import bisect_left
from threading import Lock
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.plot.panels import Curves
from pam_ros.plot.topics import Key
from pam_ros.recording.outliers import AROUND, outliers

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

COLUMNS = 6000  # of time: ten times those of the page, which can be zoomed
MOST = 5  # samples of a column that are kept
# Samples that are judged together: whether one is an outlier is seen from those around it.
JUDGED = 4 * AROUND


class History:
    """The curves of the last ``span`` seconds.

    Of each curve and each of 6000 columns of time the least, the greatest and the last sample are
    kept, and the least and the greatest outlier, for any rate and any span. One thread may add
    samples while another reads them.
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
        """Return the samples of the last ``span`` s before *end* s, and the last one before."""
        samples: dict[Key, tuple[Array, Array]] = {}
        is_outlier: dict[Key, Mask] = {}
        with self._lock:
            for key, trace in self._traces.items():
                before = end - self.span
                trace.forget(before)
                t, value, is_out = trace.points()
                seen = slice(max(int(np.searchsorted(t, before)) - 1, 0), None)
                samples[key], is_outlier[key] = (t[seen], value[seen]), is_out[seen]
        return Curves(samples, self._muscles, is_outlier)


class _Sample(NamedTuple):
    t: float
    value: float
    is_outlier: bool


class _Trace:
    """One curve: samples that are judged and thinned, and the newest ones as they came."""

    def __init__(self, width: float) -> None:
        self._width = width
        self._t, self._value, self._is_out = array('d'), array('d'), array('b')
        self._start = 0  # of what is not forgotten
        self._column: int | None = None
        self._usual: list[_Sample] = []  # the least, the greatest and the last of the column
        self._odd: list[_Sample] = []  # the same of its outliers
        self._recent: tuple[list[float], list[float]] = ([], [])
        self._settled = 0  # of the recent samples, those that are in columns already

    def add(self, t: float, value: float) -> None:
        """Add a sample; one that is published again, as in lockstep, is the same sample."""
        times, values = self._recent
        if times and times[-1] == t and values[-1] == value:
            return
        times.append(t)
        values.append(value)
        if len(times) < JUDGED:
            return
        is_out = outliers(np.array(values)).tolist()
        end = len(times) - AROUND
        for i in range(self._settled, end):
            self._settle(_Sample(times[i], values[i], is_out[i]))
        # Those around the next ones stay.
        del times[: end - AROUND], values[: end - AROUND]
        self._settled = AROUND

    def _settle(self, one: _Sample) -> None:
        column = int(one.t // self._width)
        if column != self._column:
            for kept in self._of_column():
                self._t.append(kept.t)
                self._value.append(kept.value)
                self._is_out.append(kept.is_outlier)
            self._column, self._usual, self._odd = column, [], []
        own = self._odd if one.is_outlier else self._usual
        if not own:
            own[:] = one, one, one
            return
        own[2] = one
        if one.value < own[0].value:
            own[0] = one
        elif one.value > own[1].value:
            own[1] = one

    def _of_column(self) -> list[_Sample]:
        """Return the samples of the present column that are kept, in the order of time."""
        return sorted({*self._usual, *self._odd[:2]})

    def forget(self, before: float) -> None:
        """Remove the samples before *before* s, except the last of them.

        The line to the edge of the plot starts there, and a reference is constant until the next.
        """
        self._start = max(bisect_left(self._t, before, self._start) - 1, self._start)
        if self._start > len(self._t) // 2:
            for one in (self._t, self._value, self._is_out):
                del one[: self._start]
            self._start = 0

    def points(self) -> tuple[Array, Array, Mask]:
        """Return the samples that are kept (n,), in the order of time, and the outliers."""
        column = self._of_column()
        times, values = (np.array(one) for one in self._recent)
        new = slice(self._settled, None)
        return (
            np.concatenate([self._t[self._start :], [k.t for k in column], times[new]]),
            np.concatenate([self._value[self._start :], [k.value for k in column], values[new]]),
            np.concatenate(
                [
                    np.array(self._is_out[self._start :], dtype=bool),
                    np.array([k.is_outlier for k in column], dtype=bool),
                    outliers(values)[new],
                ]
            ),
        )
