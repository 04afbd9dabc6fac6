# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A motion through points, as robot stacks send it."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

import numpy as np

from pam_ros.control.limits import refuse_unreachable
from pam_ros.control.signals import Reference
from pam_ros.errors import RangeError

CHECKS = 32  # places a piece at which the reach is checked


@dataclass(frozen=True)
class Point:
    """Where the load shall be *time* s after the start: m, and m/s and m/s^2 where given."""

    time: float
    position: float
    velocity: float | None = None
    acceleration: float | None = None


class Trajectory:
    """A piecewise polynomial through points.

    With velocities and accelerations at all points it is of fifth order between them, with
    velocities alone of third; with positions alone it is the cubic spline that is smooth in
    acceleration and at rest at both ends. Raises RangeError for points that make no motion, or
    one that leaves the *reach* (lowest, highest position in *unit*).
    """

    def __init__(
        self,
        start: Reference,
        points: Sequence[Point],
        reach: tuple[float, float],
        unit: str = 'm',
    ) -> None:
        """Pass through *points*, in order; one at time 0 takes the place of *start*."""
        _refuse_bad(points)
        if points[0].time > 0.0:
            first = Point(0.0, start.position, start.velocity, start.acceleration)
            points = [first, *points]
        elif len(points) == 1:
            points = [points[0], Point(0.001, points[0].position, 0.0, 0.0)]
        given = [p.velocity is not None for p in points[1:]]
        full = [p.acceleration is not None for p in points[1:]]
        self._times = [p.time for p in points]
        self._pieces = _pieces(points, all(given), all(given) and all(full))
        self.duration = self._times[-1]
        for n, begin in enumerate(self._times[:-1]):
            for share in range(CHECKS + 1):
                t = begin + (self._times[n + 1] - begin) * share / CHECKS
                refuse_unreachable(self.at(t).position, reach, unit)

    def at(self, t: float) -> Reference:
        """Return the reference *t* s after the start; before and after the ends, at rest."""
        if not 0.0 <= t < self.duration:
            return Reference(self._at(min(max(t, 0.0), self.duration)).position)
        return self._at(t)

    def _at(self, t: float) -> Reference:
        n = min(max(bisect_right(self._times, t) - 1, 0), len(self._pieces) - 1)
        x = t - self._times[n]
        y = v = a = j = 0.0
        # Horner's scheme for a polynomial and its derivatives at once.
        for coefficient in self._pieces[n]:
            j = j * x + a
            a = a * x + v
            v = v * x + y
            y = y * x + coefficient
        return Reference(y, v, 2.0 * a, 6.0 * j)


def _refuse_bad(points: Sequence[Point]) -> None:
    """Raise RangeError where there are no points, or stamps or values make no motion."""
    if not points:
        raise RangeError('a trajectory without points makes no motion')
    last = -1.0
    for n, p in enumerate(points):
        values = (p.time, p.position, p.velocity or 0.0, p.acceleration or 0.0)
        if not all(isfinite(value) for value in values):
            raise RangeError(f'point {n} of the trajectory is not finite: {values}')
        if p.time <= last and (n or p.time < 0.0):
            raise RangeError(
                f'point {n} of the trajectory is at {p.time:g} s: times must begin at 0 or later '
                'and grow'
            )
        last = p.time


def _pieces(points: Sequence[Point], cubic: bool, quintic: bool) -> list[list[float]]:
    """Return the coefficients between each two points, highest power first."""
    from scipy.interpolate import BPoly, CubicSpline, PPoly

    t = np.array([p.time for p in points])
    y = np.array([p.position for p in points])
    if not cubic:
        begin = points[0].velocity or 0.0
        spline = CubicSpline(t, y, bc_type=((1, begin), (1, 0.0)))
        return [list(map(float, row)) for row in spline.c.T]
    rows = [
        [p.position, p.velocity or 0.0, *([p.acceleration or 0.0] if quintic else [])]
        for p in points
    ]
    poly = PPoly.from_bernstein_basis(BPoly.from_derivatives(t, rows))
    return [list(map(float, row)) for row in poly.c.T]
