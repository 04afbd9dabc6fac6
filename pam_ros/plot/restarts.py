# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings in which time goes back: a simulation that started again, a clock that was set."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.recording.bag.clocks import LATENCY

Times = NDArray[np.int64]
SECOND = 10**9
BACK = 0.25  # s; time that goes back by more has started again, else messages are late
PAUSE = 1.0  # s on the axis of time between two parts


class TopicTimes(NamedTuple):
    """The times of the messages of a topic, and of their receipt, in the order of it, in ns."""

    received: Times
    time: Times


def one_after_another(topics: Mapping[str, TopicTimes]) -> tuple[dict[str, Times], str]:
    """Return the times of each topic with all parts one after another, and a note.

    A part ends where the time of a topic goes back by more than 0.25 s. It ends for all topics at
    the same receipt; those that have no message near it show nothing of it themselves. The next
    part begins 1 s after the end of the one before. The note is '' if time does not go back.
    """
    falls = {
        topic: np.flatnonzero(np.diff(one.time) < -BACK * SECOND) + 1
        for topic, one in topics.items()
    }
    ends = _ends(topics, falls)
    times = {topic: one.time.copy() for topic, one in topics.items()}
    if not ends:
        return times, ''
    parts = {topic: _part_numbers(one, falls[topic], ends) for topic, one in topics.items()}
    end = before = start = 0
    jumps: list[tuple[float, float]] = []  # at, and back by, both in s
    for part in range(len(ends) + 1):
        own = [found for topic in times if (found := times[topic][parts[topic] == part]).size]
        begin, last = min(int(one.min()) for one in own), max(int(one.max()) for one in own)
        shift = 0
        if part == 0:
            start = begin
        else:
            jumps.append(((end - start) / SECOND, (before - begin) / SECOND))
            shift = end + round(PAUSE * SECOND) - begin
        for topic, numbers in parts.items():
            times[topic][numbers == part] += shift
        end, before = last + shift, last
    at, back = jumps[0]
    often = '' if len(jumps) == 1 else f', the first of {len(jumps)} times'
    return times, (
        f'time goes back by {back:.3g} s at {at:.4g} s{often} (a simulation that started again, '
        'or a clock that was set): the parts are drawn one after another'
    )


def _ends(topics: Mapping[str, TopicTimes], falls: Mapping[str, Times]) -> list[int]:
    """Return the receipts at which a new part begins for topics whose time does not show it."""
    between = sorted(
        (int(one.received[i]), int(one.received[i - 1]))
        for topic, one in topics.items()
        for i in falls[topic]
    )
    ends: list[int] = []
    for last, first in between:
        # Topics show the same jump at their next message, and messages sent before may be late.
        if not ends or first >= ends[-1] + LATENCY[1] * SECOND:
            ends.append(last)
    return ends


def _part_numbers(one: TopicTimes, falls: Times, ends: list[int]) -> Times:
    """Return the number of the part (n,) of each message of a topic."""
    begins = np.searchsorted(one.received, ends, side='left')
    for i in falls:
        begins[np.searchsorted(ends, one.received[i], side='right') - 1] = i
    return np.searchsorted(begins, np.arange(one.time.size), side='right')
