# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A motion through points, as robot stacks send it."""

from bisect import bisect_right

import numpy as np

from pam_ros.control.limits import unreachable
from pam_ros.control.reference.points import Floats, Point, Points
from pam_ros.control.signals import Reference

CHECKS = 32  # parts of a piece; the reach is checked where they meet
BLOCK = 1024  # pieces that are checked at once: their numbers stay in the cache
# Share of the reach by which a motion that starts out of reach may be farther outside than the
# present reference: a planner starts at a measured position, which has noise.
START_TOLERANCE = 0.01


class ReferenceTrajectory:
    """A piecewise polynomial through points.

    With velocities and accelerations at all points it is of fifth order between them, with
    velocities alone of third order. With positions alone it is the cubic spline with a
    continuous acceleration that is at rest at both ends. Raises RangeError for points that are
    not valid, or a motion that leaves the *reach* (lowest, highest position in *unit*).

    A *start* out of reach, as that of a load that rests there without pressure, is allowed: until
    its first point within reach, the motion may be as far outside as it starts.
    """

    def __init__(
        self,
        start: Reference,
        points: Points,
        reach: tuple[float, float],
        unit: str = 'm',
    ) -> None:
        """Pass through *points*, in order; a point at time 0 replaces *start*."""
        points.refuse_bad()
        given = points
        if points.times[0] > 0.0:
            first = Point(0.0, start.position, start.velocity, start.acceleration)
            points = Points.of([first]).before(points)
        elif points.count == 1:
            end = Point(0.001, float(points.positions[0]), 0.0, 0.0)
            points = points.before(Points.of([end]))
        self._times: list[float] = points.times.tolist()
        self._pieces = _pieces(points)
        self.duration = self._times[-1]
        _refuse_out_of_reach(given, points, self._pieces, start.position, reach, unit)

    def at(self, t: float) -> Reference:
        """Return the reference *t* s after the start; at rest outside of the points."""
        if not 0.0 <= t < self.duration:
            return Reference(self._at(min(max(t, 0.0), self.duration)).position)
        return self._at(t)

    def _at(self, t: float) -> Reference:
        n = min(max(bisect_right(self._times, t) - 1, 0), len(self._pieces) - 1)
        x = t - self._times[n]
        y = v = a = j = 0.0
        # Horner's scheme for a polynomial and its derivatives at once.
        for coefficient in self._pieces[n].tolist():
            j = j * x + a
            a = a * x + v
            v = v * x + y
            y = y * x + coefficient
        return Reference(y, v, 2.0 * a, 6.0 * j)


def _pieces(points: Points) -> Floats:
    """Return the coefficients between each two points (n - 1, order + 1), highest power first."""
    from scipy.interpolate import CubicHermiteSpline, CubicSpline

    t, y, v, a = points.times, points.positions, points.velocities, points.accelerations
    if not points.has_velocity[1:].all():
        spline = CubicSpline(t, y, bc_type=((1, float(v[0])), (1, 0.0)))
        return np.ascontiguousarray(spline.c.T)
    if not points.has_acceleration[1:].all():
        return np.ascontiguousarray(CubicHermiteSpline(t, y, v).c.T)
    # The polynomial of fifth order with the given values, first and second derivatives at both
    # ends. b0, b1, b2 are the errors of these three at the second end for the Taylor polynomial
    # about the first end.
    h = np.diff(t)
    begin, end = slice(None, -1), slice(1, None)
    b0 = y[end] - (y[begin] + h * (v[begin] + 0.5 * h * a[begin]))
    b1 = h * (v[end] - (v[begin] + h * a[begin]))
    b2 = h * h * (a[end] - a[begin])
    return np.stack(
        [
            (6.0 * b0 - 3.0 * b1 + 0.5 * b2) / h**5,
            (-15.0 * b0 + 7.0 * b1 - b2) / h**4,
            (10.0 * b0 - 4.0 * b1 + 0.5 * b2) / h**3,
            0.5 * a[begin],
            v[begin],
            y[begin],
        ],
        axis=1,
    )


def _refuse_out_of_reach(
    given: Points,
    points: Points,
    pieces: Floats,
    start: float,
    reach: tuple[float, float],
    unit: str,
) -> None:
    """Raise RangeError if a point, or a place between two points, is not allowed.

    *points* are those of the motion: the *given* ones, and the start before them or an end after
    them. The message counts the *given* ones. *start* is the present reference.
    """
    before = int(points.times[0] < given.times[0])
    low, high = _bounds(points.positions, start, reach)
    # The given points are checked as they are: rounding must not reject one at the end of the
    # reach.
    is_out = ~((low <= points.positions) & (points.positions <= high))
    if is_out.any():
        n = int(np.argmax(is_out))
        position = f'position {points.positions[n]:.6g} {unit}'
        if n < before:
            what = f'{position}, the present reference, at which the trajectory starts,'
        else:
            what = f'{position} of point {n - before} of the trajectory'
        raise unreachable(what, reach, unit)
    steps = np.diff(points.times)[:, None] * (np.arange(1, CHECKS) / CHECKS)
    for first in range(0, len(pieces), BLOCK):
        block = slice(first, min(first + BLOCK, len(pieces)))
        x = steps[block]
        y = np.zeros_like(x)
        for coefficient in pieces[block].T:
            y = y * x + coefficient[:, None]
        # A piece that begins at a point out of reach leads into the reach, or towards it.
        is_out = ~((low[block, None] <= y) & (y <= high[block, None]))
        if is_out.any():
            # Nobody has sent this position: the message says where the motion has it.
            k, step = (int(i) for i in np.argwhere(is_out)[0])
            n = first + k
            raise unreachable(
                f'position {y[k, step]:.6g} {unit} of the trajectory, at '
                f'{points.times[n] + x[k, step]:.6g} s {_between(n - before, given.count)},',
                reach,
                unit,
            )


def _bounds(positions: Floats, start: float, reach: tuple[float, float]) -> tuple[Floats, Floats]:
    """Return the lowest and the highest position that are allowed at and after each point.

    These are the ends of the *reach*, and before the first of the *positions* within it also the
    *start*, if it is out of reach, with a tolerance.
    """
    low, high = reach
    lows, highs = np.full(len(positions), low), np.full(len(positions), high)
    is_within = (low <= positions) & (positions <= high)
    if not low <= start <= high and is_within.any():
        entry, tolerance = int(np.argmax(is_within)), START_TOLERANCE * (high - low)
        if start < low:
            lows[:entry] = start - tolerance
        else:
            highs[:entry] = start + tolerance
    return lows, highs


def _between(n: int, count: int) -> str:
    """Return the words for a place after point n of *count*, or after the start if n is -1."""
    if n < 0:
        return 'between its start and point 0'
    return f'between its points {n} and {n + 1}' if n + 1 < count else f'after its point {n}'
