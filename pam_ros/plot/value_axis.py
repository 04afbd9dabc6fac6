# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The vertical axis of a plot: a range that a spike of the measurement does not flatten."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.plot.panels import Curves, PanelLine
from pam_ros.plot.thinning import is_outlier
from pam_ros.plot.topics import TOPICS
from pam_ros.recording.outliers import outliers

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

MARGIN = 0.06  # of the range, above and below it
THINNEST = 1e-4  # of the largest value: the thinnest range whose ticks can be distinguished
FAR = 2.0  # ranges of the other samples; an outlier that is farther away is outside the axis


class ValueAxis(NamedTuple):
    """The range of an axis, and how many samples are above and below it."""

    low: float
    high: float
    above: int
    below: int


def judged(curves: Curves) -> Curves:
    """Return the *curves* of a recording with the outliers of those that are measured."""
    found = {
        key: outliers(value)
        for key, (_, value) in curves.samples.items()
        if not TOPICS[key.topic].is_set_point
    }
    return curves._replace(is_outlier=found)


def value_axis(lines: Sequence[PanelLine], start: float, end: float) -> ValueAxis:
    """Return the range of the values of *lines* that are seen from *start* to *end* s.

    The axis contains every sample, except outliers that are far away. An outlier is a group of at
    most five samples of a measured signal that jumps away from its neighbours and comes back,
    much farther than the signal moves around it (:func:`pam_ros.recording.outliers.outliers`). It
    is far away if it is outside the range of all other samples by more than twice this range, so
    that they would have less than a third of the axis. A step, a peak of more than five samples,
    noise and set-points are therefore always inside. The page applies the same rule.
    """
    seen = [_seen(line, start, end) for line in lines]
    values = np.concatenate([np.empty(0), *(value for value, _ in seen)])
    if not values.size:
        return ValueAxis(0.0, 1.0, 0, 0)
    is_odd = np.concatenate([is_out for _, is_out in seen])
    low, high = _range(values if is_odd.all() else values[~is_odd])
    reach = FAR * max(high - low, _thinnest(low, high))
    is_above = is_odd & (values > high + reach)
    is_below = is_odd & (values < low - reach)
    low, high = _range(values[~is_above & ~is_below])
    least, extent = _thinnest(low, high), high - low
    margin = max(MARGIN * extent, 0.5 * (least - extent), MARGIN * least)
    counts = np.count_nonzero(is_above), np.count_nonzero(is_below)
    return ValueAxis(low - margin, high + margin, *map(int, counts))


def _seen(line: PanelLine, start: float, end: float) -> tuple[Array, Mask]:
    """Return the finite values of a line that are seen, and which of them are outliers."""
    until = np.append(line.t[1:], line.t[-1:])
    is_seen = np.isfinite(line.value) & (line.t <= end) & (until >= start)
    return line.value[is_seen], is_outlier(line)[is_seen]


def _range(values: Array) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def _thinnest(low: float, high: float) -> float:
    return max(THINNEST * max(abs(low), abs(high)), 1e-9)
