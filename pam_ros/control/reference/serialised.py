# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A trajectory_msgs/JointTrajectory, read from its bytes.

To create the points as Python objects takes some 10 µs each, and meanwhile a controller sends no
command. Points of equal layout, such as those of one planner, follow each other at equal
distances in the bytes, and are read as arrays.

Encoding: Common Data Representation (CDR) of the OMG. The first four bytes give the byte order.
Values are aligned to their size, counted from the byte after these four. A sequence is its length
and its values, without padding if it is empty.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.control.reference.points import Floats, Points
from pam_ros.errors import RangeError
from pam_ros.timing.pace import SECOND

MOST_POINTS = 100_000  # of one trajectory: so many delay a command by some 0.2 s
WORD = 4  # bytes; every value of the message begins at a multiple of them
KINDS = ('positions', 'velocities', 'accelerations', 'effort')
USED = KINDS[:3]
LENGTHS, TIME = slice(0, len(KINDS)), 2 * len(KINDS)  # columns of the array of places
ORDERS = {b'\0\0': '>', b'\0\1': '<'}
CUT_OFF = 'joint_trajectory is cut off: its bytes end before its last point'


Words = NDArray[np.uint32]
Places = NDArray[np.int64]


class Sent(NamedTuple):
    """A trajectory as it was sent: the ROS time at which it begins in ns, 0 for at once."""

    begin: int
    points: Points


def read_trajectory(data: bytes, joint: str) -> Sent:
    """Return the trajectory for *joint* in the message *data*.

    Raises RangeError if the message is not for the joint, has points without a position of the
    joint or more than MOST_POINTS points, or is not a trajectory.
    """
    order = ORDERS.get(data[:2])
    if order is None:
        raise RangeError(f'joint_trajectory has an encoding that is not known: {data[:2].hex()}')
    body = data[4:]
    words = np.frombuffer(body, f'{order}u4', len(body) // WORD)
    try:
        begin = int(words[0].astype(np.int32)) * SECOND + int(words[1])
        _, at = _text(body, words, 2)
        count, at = int(words[at]), at + 1
        names: list[str] = []
        for _ in range(count):
            name, at = _text(body, words, at)
            names.append(name)
        count = int(words[at])
        if count > MOST_POINTS:
            raise RangeError(
                f'joint_trajectory has {count} points: at most {MOST_POINTS} are taken'
            )
        if count and joint not in names:
            there = ', '.join(names) or 'no joint at all'
            raise RangeError(
                f'joint_trajectory is not for joint {joint} (joint_name), but {there}'
            )
        places = _places(words, at + 1, count)
    except IndexError:
        raise RangeError(CUT_OFF) from None
    if not count:
        return Sent(begin, Points.of([]))
    lengths = words[places[:, LENGTHS][:, : len(USED)]]
    _refuse_incomplete(lengths, len(names))
    doubles = np.frombuffer(body, f'{order}f8', len(body) // (2 * WORD))
    i = names.index(joint)

    def values(kind: int) -> tuple[Floats, NDArray[np.bool_]]:
        has = lengths[:, kind] > 0
        found = np.zeros(count)
        found[has] = doubles[places[has, len(KINDS) + kind] // 2 + i]
        return found, has

    at_time = places[:, TIME]
    times = words[at_time].astype(np.int32) + words[at_time + 1] / SECOND
    (positions, _), (velocities, has_velocity), (accelerations, has_acceleration) = map(
        values, range(len(USED))
    )
    return Sent(
        begin, Points(times, positions, velocities, accelerations, has_velocity, has_acceleration)
    )


def _text(body: bytes, words: Words, at: int) -> tuple[str, int]:
    """Return the text at a place, and the place after it."""
    length, first = int(words[at]), (at + 1) * WORD
    if first + length > len(body):
        raise IndexError
    text = body[first : first + length].rstrip(b'\0').decode(errors='replace')
    return text, at + 1 + -(-length // WORD)


def _places(words: Words, at: int, count: int) -> Places:
    """Return the places of the *count* points, the first of which begins *at* this word.

    (count, 9) words: the length of each kind of values, the first value of each kind, the time.
    """
    # From the second on, points of equal layout have equal distances: the first point may be
    # aligned differently.
    head, end = _one_by_one(words, at, min(count, 2))
    if count <= 2:
        return head
    stride = end - int(head[0, TIME]) - 2
    if end + stride * (count - 2) <= len(words):
        rest = head[1] + stride * np.arange(count - 1)[:, None]
        lengths = words[rest[:, LENGTHS]]
        if np.array_equal(lengths, np.broadcast_to(lengths[0], lengths.shape)):
            return np.concatenate([head[:1], rest])
    return _one_by_one(words.tolist(), at, count)[0]


def _one_by_one(words: Words | list[int], at: int, count: int) -> tuple[Places, int]:
    """Return the places of points of any layout, and the place after the last of them."""
    rows, size = [], len(words)
    for _ in range(count):
        lengths, firsts = [], []
        for _ in KINDS:
            length = int(words[at])
            lengths.append(at)
            at += 1
            if length:
                at += at % 2
            firsts.append(at)
            at += 2 * length
        if at + 2 > size:
            raise IndexError
        rows.append((*lengths, *firsts, at))
        at += 2
    return np.array(rows, dtype=np.int64).reshape(count, TIME + 1), at


def _refuse_incomplete(lengths: Words, joints: int) -> None:
    """Raise RangeError if a point has no position, or values for another number of joints."""
    is_bad = lengths != joints
    is_bad[:, 1:] &= lengths[:, 1:] > 0
    if is_bad.any():
        n, kind = divmod(int(is_bad.argmax()), is_bad.shape[1])
        raise RangeError(
            f'point {n} of the trajectory has {lengths[n, kind]} {KINDS[kind]} for {joints} joints'
        )
