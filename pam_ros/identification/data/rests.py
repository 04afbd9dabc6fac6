# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings without the middle of their rests, in which commands and output are constant.

All samples of a rig at rest contain the same information. A search that cannot use all samples
uses the motions, and the beginning and the end of each rest.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.parts import Part
from pam_ros.identification.data.segment import FreeSegment

Array = NDArray[np.float64]
BLOCK = 1.0  # s, of which means are compared
KEPT = 2.0  # s that are kept at the beginning of a rest, and at its end
REST = 2.0  # times the noise of a sample; in a rest, noise moves these means less


def without_rests(part: Part, noise: float) -> Part:
    """Return a *part* of a free recording with short rests; later samples move to earlier times.

    A rest begins when the output has settled, and lasts to the next change of a command or to the
    end. From its beginning, means over 1 s stay within 2 times the standard deviation *noise* in m
    or rad. So a creeping output is not at rest.
    """
    segment = part.segment
    if not isinstance(segment, FreeSegment):
        return part
    rests = _rests(segment, noise)
    if not rests:
        return part
    begins, ends = np.array([(segment.t[i], segment.t[j]) for i, j in rests]).T

    def moves(t: Array) -> NDArray[np.bool_]:
        return np.asarray(~((t[:, None] >= begins) & (t[:, None] < ends)).any(axis=1))

    def earlier(t: Array) -> Array:
        # Times in a removed stretch become its end: exactly the next sample that is kept.
        at = np.where(moves(t), t, ends[np.searchsorted(ends, t, side='right') % ends.size])
        return np.asarray(at - np.clip(at[:, None] - begins, 0.0, ends - begins).sum(axis=1))

    kept, sent = moves(segment.t), moves(segment.drive_t)
    return replace(
        part,
        segment=replace(
            segment,
            t=earlier(segment.t[kept]),
            target=segment.target[kept],
            fit=segment.fit[kept],
            drive_t=earlier(segment.drive_t[sent]),
            drive=segment.drive[sent],
        ),
        division=part.division._replace(ends=earlier(part.division.ends)),
    )


def _rests(segment: FreeSegment, noise: float) -> list[tuple[int, int]]:
    """Return the first sample of the middle of each rest, and the first one after it."""
    t = segment.t
    changes = 1 + np.flatnonzero(np.any(np.diff(segment.drive, axis=0) != 0.0, axis=1))
    edges = np.unique([0, *np.searchsorted(t, segment.drive_t[changes]), t.size])
    found = []
    for first, end in pairwise(edges):
        stop = t[end - 1]
        settled = _settled(t[first:end], segment.target[first:end], noise)
        i, j = np.searchsorted(t, (settled + KEPT, stop - KEPT))
        if i < j:
            found.append((int(i), int(j)))
    return found


def _settled(t: Array, y: Array, noise: float) -> float:
    """Return the time in s from which y (n,) stays at its value at the last of the times t."""
    block = np.floor((t[-1] - t) / BLOCK).astype(int)
    means = np.bincount(block, y) / np.maximum(np.bincount(block), 1)
    highest, lowest = np.maximum.accumulate(means), np.minimum.accumulate(means)
    still = int(np.count_nonzero(highest - lowest <= REST * noise))
    return float(t[-1] - still * BLOCK)
