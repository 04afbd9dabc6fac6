# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Values that a slow sensor repeats in fast rows: each of them was measured once.

A repeated value looks as a motion that stops and then jumps, which a model explains by a dead
time. A value counts at the first of its samples: it cannot have been taken later.
"""

from dataclasses import replace

import numpy as np

from pam_ros.recording.series import Series

LARGE = 5.0  # quanta: a larger step between two values is motion, and not the resolution
FEWEST = 50  # large steps, and different values, that show whether values repeat
MOST_REPEATS = 50  # rows of one value; what is held longer, such as a set pressure, is a level
REGULAR = 0.9  # share of the values that are repeated as often as the others, or once less or more


def without_repeats(one: Series, notes: list[str]) -> Series:
    """Return the samples of *one* that are measurements, with a note if it repeats values.

    A sensor that is read in each row, but has a value only in each k-th, repeats its values k
    times while the joint moves. At rest, each k-th sample is kept. A coarse sensor has equal
    values only where it hardly moves, and keeps them.
    """
    value = one.value
    starts = np.flatnonzero(np.append(True, value[1:] != value[:-1]))
    if starts.size == value.size or starts.size < FEWEST:
        return one
    steps = np.abs(np.diff(value[starts]))
    lengths = np.diff(starts)  # rows of each value but the last
    before = lengths[steps > LARGE * steps.min()]  # of values that a large step ends
    if before.size < FEWEST or np.unique(value[starts]).size < FEWEST:
        return one
    usual = float(np.median(before))
    is_regular = np.mean(np.abs(before - usual) <= 1.0) >= REGULAR
    if not is_regular or not 1.5 < usual <= MOST_REPEATS:
        return one
    # Where a value lasts longer, as at rest, the sensor has measured it again.
    every = round(float(np.mean(before[np.abs(before - usual) <= 1.0])))
    ends = np.append(starts[1:], value.size)
    kept = np.concatenate(
        [
            [start] if end - start <= usual + 1.0 else np.arange(start, end - every // 2, every)
            for start, end in zip(starts, ends, strict=True)
        ]
    )
    span = float(one.t[-1] - one.t[0])
    if span <= 0.0:
        return one
    notes.append(
        f'{one.source} repeats its values: it was measured at about {kept.size / span:.3g} Hz, '
        'and each value counts once'
    )
    return replace(one, t=one.t[kept], value=value[kept])
