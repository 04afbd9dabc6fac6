# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The points of a trajectory as arrays: long trajectories are checked without a loop."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RangeError

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class Point:
    """Desired position *time* s after the start: m, and m/s and m/s^2 if given."""

    time: float
    position: float
    velocity: float | None = None
    acceleration: float | None = None


@dataclass(frozen=True)
class Points:
    """Points in order: arrays (n,) in s, m, m/s and m/s^2, or rad instead of m.

    A velocity or acceleration that is not given is 0.
    """

    times: Floats
    positions: Floats
    velocities: Floats
    accelerations: Floats
    has_velocity: Bools
    has_acceleration: Bools

    @staticmethod
    def of(points: Sequence[Point]) -> 'Points':
        """Return single points as arrays."""
        return Points(
            np.array([p.time for p in points], dtype=float),
            np.array([p.position for p in points], dtype=float),
            np.array([p.velocity or 0.0 for p in points], dtype=float),
            np.array([p.acceleration or 0.0 for p in points], dtype=float),
            np.array([p.velocity is not None for p in points], dtype=bool),
            np.array([p.acceleration is not None for p in points], dtype=bool),
        )

    def before(self, other: 'Points') -> 'Points':
        """Return these points, followed by those of *other*."""
        return Points(
            np.concatenate([self.times, other.times]),
            np.concatenate([self.positions, other.positions]),
            np.concatenate([self.velocities, other.velocities]),
            np.concatenate([self.accelerations, other.accelerations]),
            np.concatenate([self.has_velocity, other.has_velocity]),
            np.concatenate([self.has_acceleration, other.has_acceleration]),
        )

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.times)

    def refuse_bad(self) -> None:
        """Raise RangeError if there are no points, or if times or values are not valid."""
        if not self.count:
            raise RangeError('a trajectory without points makes no motion')
        columns = self.times, self.positions, self.velocities, self.accelerations
        table = np.stack(columns, axis=1)
        is_finite: Bools = np.logical_and.reduce(np.isfinite(table), axis=1)
        does_grow = np.diff(self.times, prepend=-1.0) > 0.0
        does_grow[0] = not self.times[0] < 0.0
        bad = np.flatnonzero(~np.logical_and(is_finite, does_grow))
        if not bad.size:
            return
        n = int(bad[0])
        if not is_finite[n]:
            raise RangeError(
                f'point {n} of the trajectory is not finite: {tuple(table[n].tolist())}'
            )
        raise RangeError(
            f'point {n} of the trajectory is at {self.times[n]:g} s: times must begin at 0 or '
            'later and grow'
        )
