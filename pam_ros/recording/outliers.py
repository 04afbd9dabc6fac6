# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Samples that are no measurements: a glitch of an encoder, a zero of a dropout, a spike.

Such a sample jumps away from its neighbours and back, much farther than the signal moves around
it. A real event, such as a stop or a load that is dropped, does not come back to where it was.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError
from pam_ros.recording.series import Series

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
LONGEST = 5  # samples of one outlier
AROUND = 20  # samples on each side that show how the signal moves
USUAL = 75.0  # percentile of their distances from their neighbours: some are of other outliers
FAR = 15.0  # times this distance: both jumps of an outlier are larger
# Times the largest of the steps before and behind it: a motion that turns is no outlier. One that
# is small is much larger than these, since sensors have small errors that are not outliers.
FAST, FASTER = 2.0, 12.0
BESIDE = 2  # steps before and behind
LARGE = 0.02  # share of the range of the signal above which a jump is not small
QUANTA = 5.0  # of the resolution, below which a jump is none
BACK = 0.75  # share of the smaller jump within which the signal is back where it was
MOST = 0.02  # share of the samples above which a signal is not usable
NAMED = 3  # outliers whose times are named


class TooManyOutliersError(RecordingError):
    """A signal has so many outliers that it is not usable."""


def without_outliers(one: Series, notes: list[str]) -> Series:
    """Return the samples of *one* that can be measurements, with a note on the others.

    Raises TooManyOutliersError if too many cannot be.
    """
    is_out = outliers(one.value)
    count = int(np.count_nonzero(is_out))
    if not count:
        return one
    at = one.t[is_out]
    times = ', '.join(f'{t:.6g}' for t in at[:NAMED]) + (', ...' if count > NAMED else '')
    what = f'{count} of {is_out.size} samples of {one.source}'
    if count > max(MOST * is_out.size, 1):
        raise TooManyOutliersError(
            f'{what} jump away from their neighbours and back, at {times} s: too many for a '
            'usable signal (a loose contact, or two signals in one column?)'
        )
    verb = 'is an outlier and is' if count == 1 else 'are outliers and are'
    notes.append(f'{what} {verb} left out, at {times} s')
    return replace(one, t=one.t[~is_out], value=one.value[~is_out])


def outliers(value: Array) -> Mask:
    """Return which samples of *value* (n,) jump away from their neighbours and back."""
    steps = np.diff(value)
    sizes = np.abs(steps)
    is_out = np.zeros(value.size, dtype=bool)
    if value.size < 2 * LONGEST or not sizes.any():
        return is_out
    # How far a sample is from the middle of its neighbours, in noise and in motion.
    bends = 0.5 * np.abs(np.diff(steps))
    extent = float(np.diff(np.percentile(value, (0.5, 99.5)))[0])
    least = max(FAR * float(np.median(bends)), QUANTA * float(sizes[sizes > 0.0].min()))
    for length in range(1, LONGEST + 1):
        # The jump away, and the one back.
        away, back = steps[:-length], steps[length:]
        smaller = np.minimum(np.abs(away), np.abs(back))
        offset = np.abs(value[length + 1 :] - value[: -length - 1])
        # Most samples are sorted out here, without a look at those around them.
        is_far = (away * back < 0.0) & (offset <= BACK * smaller) & (smaller > least)
        for k in np.flatnonzero(is_far).tolist():
            bent = _usual(bends, max(k - 1, 0), k + length + 1)
            beside = np.append(sizes[max(k - BESIDE, 0) : k], sizes[k + length + 1 :][:BESIDE])
            times = FAST if smaller[k] > LARGE * extent else FASTER
            if smaller[k] > max(FAR * bent, times * float(beside.max(initial=0.0))):
                is_out[k + 1 : k + 1 + length] = True
    return is_out


def _usual(values: Array, end: int, start: int) -> float:
    """Return the usual size of *values* (n,) before the index *end* and from *start* on."""
    around = np.concatenate([values[max(end - AROUND, 0) : end], values[start : start + AROUND]])
    return float(np.percentile(around, USUAL)) if around.size else 0.0
