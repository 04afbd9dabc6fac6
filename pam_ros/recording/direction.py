# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which way a machine counts the position of an actuator that it moves to and fro."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pam_ros.recording.assemble import spread
from pam_ros.recording.recording import Recording

Array = NDArray[np.float64]
LEAST = 0.1  # share of its range by which a position turns round
ENOUGH = 2  # cycles that must agree
# Share of the range of the force times that of the position below which a loop is none: a force
# cell that lags behind a spring makes one of 1 or 2 %.
LOOP = 0.1


def with_contraction_positive(recording: Recording) -> Recording:
    """Return *recording* with a position that grows the way in which the actuator pulls.

    Moved to and fro at a constant pressure an actuator takes work: integral F dy < 0 over each
    cycle, y positive where it follows its own force. Where every cycle gives off more work than
    the changes of the measured pressure could have done, and more than a lag of the force cell
    could feign, the position counts the other way: its sign is changed, and a warning says so.
    Recordings of other kinds are returned as they are.
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
        f'the force gives off {float(np.mean(work)):.3g} J in each cycle of the position at a '
        'constant pressure, which no actuator can: the position counts against its pull, and is '
        'taken with the other sign'
    )
    velocity = None if recording.velocity is None else -recording.velocity
    return replace(recording, position=-y, velocity=velocity, warnings=(*recording.warnings, note))


def work_of_cycles(y: Array, f: Array) -> list[float]:
    """Return the integral of the force f (n,) in N over each cycle of the position y (n,) in m.

    A cycle goes from one highest position to the next, in J.
    """
    tops = _tops(y)
    step = 0.5 * (f[1:] + f[:-1]) * np.diff(y)
    # A cycle may end a little higher than it began, where its mean force has moved it.
    return [float(np.sum(step[a:b]) - np.mean(f[a:b]) * (y[b] - y[a])) for a, b in pairwise(tops)]


def _least(y: Array, f: Array, p: Array) -> float:
    """Return the work in J from which on a cycle says something of the position's direction."""
    mean = float(np.mean(np.abs(p)))
    gain = float(np.max(np.abs(f))) / mean if mean > 0.0 else float('inf')
    # What the changes of the pressure p could do.
    by_pressure = gain * spread(p) if spread(p) > 0.0 else 0.0
    return max(by_pressure, LOOP * spread(f)) * float(np.ptp(y))


def _tops(y: Array) -> list[int]:
    """Return where the position is highest between two of its falls."""
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
