# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sign of the position of an actuator that a testing machine moves back and forth."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pam_ros.recording.assemble import spread
from pam_ros.recording.recording import Recording

Array = NDArray[np.float64]
LEAST = 0.1  # share of its range by which a position must change to count as a reversal
ENOUGH = 2  # cycles that must agree
# Least area of a loop, as a share of the range of the force times that of the position. The lag of
# a force cell makes a loop of 1 or 2 % even with a spring.
LOOP = 0.1


def with_contraction_positive(recording: Recording) -> Recording:
    """Return *recording* with a position that increases in the direction of the actuator's pull.

    An actuator that is moved back and forth at a constant pressure absorbs work: integral F dy < 0
    over each cycle, if y increases in the direction of its force. If every cycle delivers more
    work than the changes of the measured pressure could have done, and more than a lag of the
    force cell could imitate, the position has the opposite sign. Its sign is then changed, and a
    warning is added. Recordings of other kinds are returned unchanged.
    """
    y, f, p = recording.position, recording.force, recording.pressure
    if recording.kind != 'held' or y is None or f is None or p is None:
        return recording
    edges = np.searchsorted(recording.t, [end for _, end in recording.gaps])
    parts = zip(np.split(y, edges), np.split(f, edges), strict=True)
    work = [each for part in parts for each in work_of_cycles(*part)]
    if len(work) < ENOUGH or min(work) <= _least(y, f, p):
        return recording
    note = (
        f'the force delivers {float(np.mean(work)):.3g} J in each cycle of the position at a '
        'constant pressure, which is impossible for an actuator: the position increases against '
        'its pull, and its sign is changed'
    )
    velocity = None if recording.velocity is None else -recording.velocity
    return replace(recording, position=-y, velocity=velocity, warnings=(*recording.warnings, note))


def work_of_cycles(y: Array, f: Array) -> list[float]:
    """Return the work in J, the integral of f (n,) in N over y (n,) in m, of each cycle of y.

    A cycle goes from one maximum of the position to the next.
    """
    tops = _tops(y)
    step = 0.5 * (f[1:] + f[:-1]) * np.diff(y)
    # A cycle may end a little higher than it began: the work of its mean force is subtracted.
    return [float(np.sum(step[a:b]) - np.mean(f[a:b]) * (y[b] - y[a])) for a, b in pairwise(tops)]


def _least(y: Array, f: Array, p: Array) -> float:
    """Return the work in J above which a cycle shows that the position has the wrong sign."""
    mean = float(np.mean(np.abs(p)))
    gain = float(np.max(np.abs(f))) / mean if mean > 0.0 else float('inf')
    # The force that the changes of the pressure p could cause.
    by_pressure = gain * spread(p) if spread(p) > 0.0 else 0.0
    return max(by_pressure, LOOP * spread(f)) * float(np.ptp(y))


def _tops(y: Array) -> list[int]:
    """Return the indices of the maxima of the position, each after a rise and before a fall."""
    least = LEAST * float(np.ptp(y))
    found: list[int] = []
    top = low = 0
    rises = False
    for k, x in enumerate(y.tolist()):
        if rises:
            top = k if x > y[top] else top
            if y[top] - x > least:
                found.append(top)
                rises, low = False, k
        else:
            low = k if x < y[low] else low
            if x - y[low] > least:
                rises, top = True, k
    return found
