# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated time at which the messages of a bag were received, if its recorder did not use it.

A simulation may be faster or slower than the clock of the recorder, or wait for a controller. The
times of receipt of messages without a header, such as commands, are then not on the axis of the
others. They are converted with ``/clock``, as ``pam_record`` does while it records, or without
it with the stamps of the headers. All times are in ns.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pam_ros.recording.bag.clocks import (
    LATENCY,
    SIMULATED,
    Samples,
    Times,
    filled_stamps,
    received_times,
)
from pam_ros.recording.bag.source import BagSource
from pam_ros.recording.simulated_time import SimulatedTime

CLOCK, CLOCK_TYPE = '/clock', 'rosgraph_msgs/msg/Clock'
# The difference of two clocks of the same rate is constant. They have different rates if it
# changes by more than this share of the recording, or by more than so many s.
RATE, MOST_CHANGE = 0.05, 2.0 * LATENCY[1]


@dataclass(frozen=True, eq=False)
class ClockTimes:
    """Times of receipt and the simulated times that belong to them, both (n,)."""

    received: Times
    time: Times

    def convert(self, received: Times) -> Times:
        """Return the simulated times at which messages were *received* (n,).

        Before the first known time it is the first one, after the last one the last.
        """
        known = SimulatedTime(kept=self.received.size)
        for sent, time in zip(self.received.tolist(), self.time.tolist(), strict=True):
            known.tell(sent, time)
        found = [(at, known.at(at)) for at in received.tolist()]
        return np.array(
            [known.before(at) if time is None else time for at, time in found], dtype=np.int64
        )


def clock_times(source: BagSource) -> ClockTimes | None:
    """Return the times on ``/clock`` in a bag, None if it has none."""
    topic = source.topics.get(CLOCK)
    if topic is None or topic.type != CLOCK_TYPE:
        return None
    messages = list(source.messages([CLOCK]))
    clocks = [source.decode(topic, message.data).clock for message in messages]
    time = np.array([now.sec * 10**9 + now.nanosec for now in clocks], dtype=np.int64)
    is_set = time > 0
    if not is_set.any():
        return None
    return ClockTimes(received_times(CLOCK, messages)[is_set], time[is_set])


def on_simulated_clock(
    samples: dict[str, Samples], clock: ClockTimes | None, notes: list[str]
) -> dict[str, Samples]:
    """Return *samples* with their receipts in simulated time, with a note; or as they are.

    They are converted if the recorder used a real clock and headers are of a simulated one: with
    *clock* if the bag has it, else with the headers of the topic that has most messages, if their
    clock has another rate. Without any header that is filled, ``/clock`` is sufficient.
    """
    receipts = [one.received for one in samples.values()]
    if not receipts or np.mean(np.concatenate(receipts) >= SIMULATED) < 0.5:
        return samples
    stamped = {topic: filled_stamps(one) for topic, one in samples.items()}
    of_headers = {
        topic: ClockTimes(samples[topic].received[mask], samples[topic].stamped[mask])
        for topic, mask in stamped.items()
        if mask.any() and np.mean(samples[topic].stamped[mask] < SIMULATED) > 0.5
    }
    if not of_headers and any(mask.any() for mask in stamped.values()):
        return samples
    if clock is not None and np.mean(clock.time < SIMULATED) > 0.5:
        known, what = clock, CLOCK
    elif of_headers:
        topic = max(of_headers, key=lambda name: of_headers[name].received.size)
        known, what = of_headers[topic], f'the headers of {topic}'
        if not _has_other_rate(known):
            return samples
    else:
        return samples
    notes.append(
        'the bag was recorded in real time and the rig was in simulated time: times of receipt '
        f'are converted to simulated time with {what}'
    )
    return {
        topic: one._replace(received=known.convert(one.received)) for topic, one in samples.items()
    }


def _has_other_rate(one: ClockTimes) -> bool:
    """Return whether the two clocks of *one* have different rates."""
    steps = np.diff(one.received - one.time)[np.diff(one.time) >= 0]
    change: NDArray[np.int64] = np.cumsum(np.append(0, steps))
    span = float(one.received.max() - one.received.min())
    return bool(np.ptp(change) > min(RATE * span, MOST_CHANGE * 1e9))
