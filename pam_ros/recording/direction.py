# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The signs of force and position of an actuator that a testing machine holds or moves."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pam_ros.recording.assemble import spread
from pam_ros.recording.inputs import driving
from pam_ros.recording.recording import Recording

Array = NDArray[np.float64]
LEAST = 0.1  # share of its range by which a position must change to count as a reversal
ENOUGH = 2  # cycles that must agree
SMALL = 0.01  # share of an input that must change at the same position
FALLS = -0.8  # correlation of pressure and force below which the force clearly falls
# Least area of a loop, as a share of the range of the force times that of the position. The lag of
# a force cell makes a loop of 1 or 2 % even with a spring.
LOOP = 0.1


def with_tension_positive(recording: Recording) -> Recording:
    """Return *recording* with a force that is positive where the actuator pulls.

    A muscle pulls more at a higher pressure. If the force is negative and falls as the pressure
    rises, tension was counted negative: the sign is changed, and a warning is added. A positive
    force that falls is not changed, since its zero may be wrong as well: the warning asks.
    Recordings without a clear dependence, and those of other kinds, are returned unchanged.
    """
    f = recording.force
    if recording.kind != 'held' or f is None or recording.position is None:
        return recording
    (drive,) = driving(recording)
    if correlation(drive.values, f, recording.position) > FALLS:
        return recording
    if float(np.median(f)) < 0.0:
        note = (
            'the force is negative and falls as the pressure rises: tension is counted negative, '
            'and the sign of the force is changed'
        )
        return replace(recording, force=-f, warnings=(*recording.warnings, note))
    note = (
        'the force falls as the pressure rises, and a muscle pulls more: is the sign of the force '
        'or of the pressure wrong, or are both of different muscles?'
    )
    return replace(recording, warnings=(*recording.warnings, note))


def correlation(x: Array, f: Array, y: Array) -> float:
    """Return the correlation of x and f, all (n,), at the same y; 0 if x is constant there."""
    basis = np.vander(y - np.mean(y), 4) if np.ptp(y) > 0.0 else np.ones((y.size, 1))
    left = [one - basis @ np.linalg.lstsq(basis, one, rcond=None)[0] for one in (x, f)]
    sizes = [float(np.linalg.norm(one)) for one in left]
    if sizes[0] <= SMALL * float(np.linalg.norm(x)) or sizes[1] == 0.0:
        return 0.0
    return float(left[0] @ left[1]) / (sizes[0] * sizes[1])


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
