# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Lines thinned to the resolution of a plot; each point that is left is one of the samples."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.plot.panels import Panel, PanelLine

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


def thinned(panel: Panel, start: float, end: float, columns: int | None) -> Panel:
    """Return a plot from *start* to *end* s, thinned to *columns* of time; None thins nothing.

    Each line keeps its least and its greatest value of each column, those of its outliers, its
    gaps, and the samples before *start* and after *end*, to which a line at the edge leads. A
    line that is held keeps the last sample of each column as well.
    """
    return replace(panel, lines=[_thinned(line, start, end, columns) for line in panel.lines])


def _thinned(line: PanelLine, start: float, end: float, columns: int | None) -> PanelLine:
    t, value = line.t, line.value
    kept = np.flatnonzero((t >= start) & (t <= end))
    before, after = np.flatnonzero(t < start)[-1:], np.flatnonzero(t > end)[:1]
    if columns is not None and kept.size > 2 * columns:
        column = np.floor((t[kept] - start) / (end - start) * columns)
        own = value[kept]
        is_gap = np.isnan(own)
        is_odd = is_outlier(line)[kept]
        parts = [np.flatnonzero(is_gap)]
        for is_own in (~is_gap & ~is_odd, ~is_gap & is_odd):
            chosen = np.flatnonzero(is_own)
            parts.append(chosen[_extremes(column[chosen], own[chosen], line.is_held)])
        kept = kept[np.unique(np.concatenate(parts))]
    order = np.unique(np.concatenate([before, kept, after]))
    return replace(line, t=t[order], value=value[order])


def is_outlier(line: PanelLine) -> NDArray[np.bool_]:
    """Return which points of a line (n,) are outliers."""
    if not line.outliers.size:
        return np.zeros(line.t.size, dtype=bool)
    return np.isin(line.t, line.outliers) & np.isfinite(line.value)


def _extremes(column: Array, value: Array, with_last: bool) -> Indices:
    """Return the indices of the least and the greatest value of each column, or its last."""
    if not value.size:
        return np.empty(0, dtype=np.intp)
    starts = np.flatnonzero(np.diff(column, prepend=column[0] - 1.0))
    counts = np.diff(np.append(starts, value.size))
    number = np.repeat(np.arange(starts.size), counts)
    found = [starts + counts - 1] if with_last else []
    for extreme in (np.minimum, np.maximum):
        at = np.flatnonzero(value == np.repeat(extreme.reduceat(value, starts), counts))
        found.append(at[np.diff(number[at], prepend=-1) > 0])
    return np.concatenate(found)
