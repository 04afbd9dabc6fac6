# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The times of the messages of a bag: the stamps of their headers, or the times of their receipt.

All times are in ns, as they are in ROS.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError
from pam_ros.recording.bag.source import Message
from pam_ros.recording.series import COARSE

Times = NDArray[np.int64]
Mask = NDArray[np.bool_]
TIMES = ('header', 'received')
LATENCY = (-2e-3, 0.5)  # s from the stamp of a header to its receipt; outside, clocks differ
LATEST = 2**63 - 1  # ns: the largest time in ROS; an MCAP file can hold twice as much
SIMULATED = 10**18  # ns: no real clock is before 2001
TICK = 0.1  # s by which a simulated clock, published in ticks, may be behind a header
LATE_START = 10**9  # ns: a first time after 0 by more than this means that 0 is not a time
FINER = 0.5  # share of the equal stamps of headers that times of receipt may have to be finer


class Samples(NamedTuple):
    """The samples of one topic: receive times and header stamps, columns of numbers.

    For each field, ``present`` is false where a message is not of its joint.
    """

    received: Times
    stamped: Times
    columns: list[NDArray[np.float64]]
    present: list[Mask]


class Timed(NamedTuple):
    """The times of those messages of a topic that ``kept`` marks, and whether of their receipt."""

    time: Times
    kept: Mask
    is_received: bool


def received_times(name: str, messages: Sequence[Message]) -> Times:
    """Return the times of receipt (n,) of the *messages* of one topic in the bag called *name*.

    Raises RecordingError for a time that ROS cannot hold.
    """
    last = max(messages, key=lambda message: message.stamp)
    if last.stamp > LATEST:
        raise RecordingError(
            f'{name}: {last.topic} has a message received at {last.stamp} ns: give stamps of at '
            f'most {LATEST} ns'
        )
    return np.array([message.stamp for message in messages], dtype=np.int64)


def stamp_of(message: Any) -> int:
    """Return the stamp in the header of a message in ns, 0 if it has no header."""
    stamp = getattr(getattr(message, 'header', None), 'stamp', None)
    return 0 if stamp is None else int(stamp.sec * 10**9 + stamp.nanosec)


@dataclass(frozen=True)
class _Receipts:
    """The clock of the recorder: whether it is a real one, and the first time that it had."""

    is_real: bool
    first: int
    is_zero_unset: bool

    @classmethod
    def of(cls, samples: dict[str, Samples]) -> '_Receipts | None':
        """Return the clock of the receipts of *samples*, None if it never had a time.

        A recorder in simulated time stores 0 until it receives the first ``/clock``. A computer
        without a battery begins in 1970, until its clock is set.
        """
        every = np.concatenate([one.received for one in samples.values()])
        later = every[every > 0]
        if not later.size:
            return None
        is_real = bool(np.mean(later >= SIMULATED) >= 0.5)
        first = int(later[(later >= SIMULATED) == is_real].min())
        return cls(is_real, first, is_real or first > LATE_START)

    def have(self, times: Times) -> Mask:
        """Return which of *times* (n,) are of this clock, and not from before it was set."""
        is_set = times > 0 if self.is_zero_unset else times >= 0
        return np.asarray(is_set & ((times >= SIMULATED) == self.is_real))


def timed(
    name: str,
    samples: dict[str, Samples],
    commands: Collection[str],
    time: str,
    notes: list[str],
) -> tuple[dict[str, Timed], int]:
    """Return the times of the messages of each topic, and the first time of the bag called *name*.

    *time* is ``header`` or ``received``. The stamps of headers are used where they are filled, of
    the clock of the recorder, and not coarser than the times of receipt. Messages from before the
    clock was set are left out, with a note; the last one of *commands* has acted since then. It
    gets the first time of the recorder. Raises RecordingError if a topic has no times.
    """
    if not samples:
        return {}, 0
    clock = _Receipts.of(samples)
    use_header = time == 'header' and _headers_agree(samples, clock, notes)
    found = {}
    for topic, one in samples.items():
        header = _header_times(topic, one, notes) if use_header else None
        if header is not None:
            found[topic] = header
        elif clock is None:
            raise RecordingError(
                f'{name}: all messages of {topic} were received at time 0: the recorder used '
                'simulated time without /clock; record with /clock, or without use_sim_time'
            )
        else:
            found[topic] = _receipt_times(name, topic, one, clock, topic in commands, notes)
    if clock is not None:
        return found, clock.first
    return found, min(int(one.time.min()) for one in found.values())


def _headers_agree(samples: dict[str, Samples], clock: _Receipts | None, notes: list[str]) -> bool:
    """Return whether headers and receipts have the same clock; add a note if they do not."""
    if clock is None:
        return True
    for topic, one in samples.items():
        both = filled_stamps(one) & clock.have(one.received)
        if not both.any() or _has_few_stamps(one):
            continue
        late = 1e-9 * float(np.median((one.received - one.stamped)[both]))
        early = LATENCY[0] if clock.is_real else -TICK
        if not early <= late <= LATENCY[1]:
            notes.append(
                f'{topic} was stamped by a clock {late:.4g} s behind that of the recorder: all '
                'messages get the time of their receipt'
            )
            return False
    return True


def filled_stamps(one: Samples) -> Mask:
    """Return which messages count by the stamps of their headers; none if they are not filled.

    A program in simulated time stamps its messages with 0 until it receives the first ``/clock``.
    """
    is_set = one.stamped > 0
    begins = int(np.argmax(is_set))
    if not is_set.any() or not is_set[begins:].all() or begins > is_set.size // 2:
        return np.zeros_like(is_set)
    return is_set


def _has_few_stamps(one: Samples) -> bool:
    """Return whether the stamps of the headers are coarser than the times of receipt.

    Some drivers fill only the seconds. A message that is published again has equal values.
    """
    filled = filled_stamps(one)
    values = np.column_stack(one.columns)[filled]
    differs = (values[1:] != values[:-1]).any(axis=1)
    stamped, received = (
        np.count_nonzero(differs & (np.diff(times[filled]) == 0))
        for times in (one.stamped, one.received)
    )
    return bool(stamped > max(COARSE * one.received.size, 2) and received < FINER * stamped)


def _header_times(topic: str, one: Samples, notes: list[str]) -> Timed | None:
    """Return the stamps of the headers of a topic, None if they cannot be used."""
    kept = filled_stamps(one)
    if not kept.any():
        return None
    if _has_few_stamps(one):
        count = np.unique(one.stamped).size
        notes.append(
            f'the headers of the {one.stamped.size} messages of {topic} have only {count} '
            'different stamps: they get the time of their receipt'
        )
        return None
    _note_unset(topic, kept, 'were stamped', notes)
    return Timed(one.stamped[kept], kept, is_received=False)


def _receipt_times(
    name: str, topic: str, one: Samples, clock: _Receipts, is_command: bool, notes: list[str]
) -> Timed:
    """Return the times of receipt of a topic."""
    kept, time = clock.have(one.received), one.received.copy()
    unset = np.flatnonzero(~kept)
    if is_command and unset.size:
        # Any value of the clock that was set later is greater, so that it has acted since then.
        kept[unset[-1]], time[unset[-1]] = True, clock.first
    if not clock.is_real and not is_command:
        kept[_while_standing(time, clock.first)] = False
    if not kept.any():
        raise RecordingError(
            f'{name}: all messages of {topic} were received before the clock was set'
        )
    _note_unset(topic, kept, 'were received', notes)
    return Timed(time[kept], kept, is_received=True)


def _while_standing(time: Times, first: int) -> NDArray[np.int_]:
    """Return the messages that were received while simulated time stood still at its *first*.

    Only the last message with that time is near it. Later, several messages between two ticks of
    the clock may share their time as well.
    """
    at_first = np.flatnonzero(time == first)
    usual = np.unique(time[time > first], return_counts=True)[1]
    return at_first[:-1] if at_first.size > 2 * np.max(usual, initial=1) else at_first[:0]


def _note_unset(topic: str, kept: Mask, what: str, notes: list[str]) -> None:
    count = int(np.count_nonzero(~kept))
    if count:
        notes.append(
            f'{count} of {kept.size} messages of {topic} {what} before the clock was set (before '
            'the first /clock in simulated time): they are left out'
        )
