# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which times of a recording are fitted, which decide between models, and which judge.

What is fitted and what decides both need what the recording contains: the pressure rises and
falls, over its range. A model that was fitted while the pressure rose says little about its fall.
Where the first and the next part of the time have this, they are used. Otherwise, as in one slow
cycle, both are blocks in turn. The choice depends on the inputs alone.

The last part of the time judges in both cases. It tests how well a free run continues. Blocks
between those that are fitted would not: with them, effects that the rig did not have were
accepted in slow cycles, because three effects can interpolate almost any slow error.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.recording.inputs import driving
from pam_ros.recording.recording import Recording

Array = NDArray[np.float64]
FIT, CHOOSE, JUDGE = range(3)
LEFT_OUT = -1  # the role of samples in which an effect develops: they are in no part
BLOCKS = 20  # of a recording with interleaved parts: 3 s of a minute
GOLDEN = 0.6180339887  # the fractional parts of its multiples fill 0 to 1 without a period
# Changes of the input within this share of its range are no change of its direction.
DEAD_BAND = 0.1
# A part contains a direction if it has a tenth of what falls to it by its duration. In 144
# recordings with random steps, each part had at least 0.13.
LEAST_TRAVEL = 0.1
LEAST_RANGE = 0.3  # of the range of the input; a slow ramp has 0.2 in a fifth of its time
MOST_SAMPLES = 20_000  # of an input: enough for its directions


class Division(NamedTuple):
    """The blocks of a recording, and the role of each.

    ``ends`` (m,) are the times in s, ascending, at which a block ends. ``roles`` (m + 1,) are the
    roles of the blocks: a block is fitted, decides between models, or judges.
    """

    ends: Array
    roles: NDArray[np.int_]

    def at(self, t: Array) -> NDArray[np.int_]:
        """Return the roles (n,) of the times t (n,) in s."""
        return np.asarray(self.roles[np.searchsorted(self.ends, t, side='right')])

    @property
    def is_in_turn(self) -> bool:
        """Whether blocks that decide come before blocks that are fitted."""
        fit, choose = (np.flatnonzero(self.roles == role) for role in (FIT, CHOOSE))
        return bool(fit.size and choose.size and choose[0] < fit[-1])

    def without(self, start: float, end: float) -> 'Division':
        """Return the division in which the times from *start* to *end* s have no role."""
        inside = (self.ends > start) & (self.ends <= end)
        first, last = (int(np.searchsorted(self.ends, at, side='right')) for at in (start, end))
        ends = np.sort(np.concatenate([self.ends[~inside], [start, end]]))
        return Division(ends, np.array([*self.roles[: first + 1], LEFT_OUT, *self.roles[last:]]))


def divide(recording: Recording, start: float, end: float, fit: float, choose: float) -> Division:
    """Return the division of *recording* between *start* and *end* in s.

    *fit* is the share of the time that is fitted, *choose* the share that is fitted or decides.
    """
    if recording.kind != 'free':
        return divide_in_turn(start, end, fit, choose, 1.0)
    in_time = divide_in_time(start, end, fit, choose)
    if contain_all(in_time, recording):
        return in_time
    in_turn = divide_in_turn(start, end, fit, choose, choose)
    return in_turn if contain_all(in_turn, recording) else in_time


def with_one_role(start: float, end: float, role: int, choose: float) -> Division:
    """Return the division in which all that does not judge has one *role*, see :func:`divide`."""
    return _division(start, end, np.array([choose]), np.array([role, JUDGE]))


def divide_in_time(start: float, end: float, fit: float, choose: float) -> Division:
    """Return the division into the first, the next and the last part, see :func:`divide`."""
    return _division(start, end, np.array([fit, choose]), np.array([FIT, CHOOSE, JUDGE]))


def divide_in_turn(start: float, end: float, fit: float, choose: float, until: float) -> Division:
    """Return the division into blocks in turn, up to the share *until* of the time.

    What comes later judges.
    """
    places = np.arange(1, BLOCKS + 1) / BLOCKS * until
    roles = np.searchsorted([fit, choose], draws(BLOCKS) * until, side='right')
    return _division(start, end, places, np.append(roles, JUDGE))


def _division(start: float, end: float, places: Array, roles: NDArray[np.int_]) -> Division:
    # The last sample belongs to the last part that is not empty.
    return Division(np.where(places < 1.0, start + places * (end - start), np.inf), roles)


def contain_all(division: Division, recording: Recording) -> bool:
    """Return whether *fit* and *choose* both contain the directions and the range of the inputs.

    A direction counts if the recording contains it.
    """
    step = -(-recording.t.size // MOST_SAMPLES)
    t = recording.t[::step]
    roles = division.at(t)
    masks = [roles == role for role in (FIT, CHOOSE)]
    if not all(mask.any() for mask in masks):
        return False
    for one in driving(recording):
        values = one.values[::step]
        extent = float(np.ptp(values))
        if extent == 0.0:
            continue
        change = np.diff(_without_small_changes(values, DEAD_BAND * extent))
        for mask in masks:
            if np.ptp(values[mask]) < LEAST_RANGE * extent:
                return False
            least = LEAST_TRAVEL * float(np.mean(mask))
            for travel in (np.maximum(change, 0.0), np.maximum(-change, 0.0)):
                if travel[mask[1:]].sum() < least * travel.sum():
                    return False
    return True


def _without_small_changes(values: Array, width: float) -> Array:
    """Return *values* (n,) behind a play of this *width*, which follows only larger changes."""
    half, now = 0.5 * width, float(values[0])
    found = []
    for value in values.tolist():
        now = min(max(now, value - half), value + half)
        found.append(now)
    return np.array(found)


def deciding(recordings: Sequence[Recording], share: float) -> set[int]:
    """Return the indices of the free recordings that decide as a whole; none if there are few.

    Their duration is at most this *share* of the total duration.
    """
    if recordings[0].kind != 'free':
        return set()
    times = [recording.duration for recording in recordings]
    found: set[int] = set()
    for k in np.argsort(-draws(len(recordings)), kind='stable').tolist():
        if sum(times[i] for i in (*found, k)) <= share * sum(times):
            found.add(k)
    return found


def draws(count: int) -> Array:
    """Return numbers (count,) between 0 and 1, without a period."""
    return np.asarray(np.arange(1, count + 1) * GOLDEN % 1.0, dtype=float)
