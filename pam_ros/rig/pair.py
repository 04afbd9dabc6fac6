# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Two muscles on one coordinate: the pressures for an effort and a stiffness, in closed form.

At a coordinate, muscle i gives the effort a_i + b_i p_i and the stiffness c_i + d_i p_i. Desired
values of both give two linear equations for the two pressures. The pressures that give the effort
alone are on a line, and the limits of pressure leave a segment of this line. The stiffness changes
along the segment; its ends give the least and the greatest possible stiffness. Scalars, SI.
"""

from typing import NamedTuple

Limits = tuple[float, float]


class Line(NamedTuple):
    """Effort a + b p and stiffness c + d p of a muscle at the coordinate, p in Pa."""

    a: float
    b: float
    c: float
    d: float

    @property
    def slack(self) -> float:
        """Pressure in Pa below which the muscle pushes according to the force law."""
        return -self.a / self.b


def is_settled(one: Line, two: Line) -> bool:
    """Return whether the effort determines the stiffness, as for equal muscles in parallel."""
    left, right = one.b * two.d, two.b * one.d
    return abs(left - right) < 1e-9 * (abs(left) + abs(right))


def pressures(one: Line, two: Line, effort: float, stiffness: float) -> tuple[float, float]:
    """Return the pressures in Pa that give both, without regard to limits."""
    tau, k = effort - one.a - two.a, stiffness - one.c - two.c
    scale = one.b * two.d - two.b * one.d
    return (tau * two.d - k * two.b) / scale, (k * one.b - tau * one.d) / scale


def other(one: Line, two: Line, effort: float, p: float) -> float:
    """Return the pressure of the second muscle for *effort* if the first muscle has *p* Pa."""
    return (effort - one.a - two.a - one.b * p) / two.b


def piece(one: Line, two: Line, effort: float, within: tuple[Limits, Limits]) -> Limits:
    """Return the least and greatest possible pressure of the first muscle with *effort*.

    *within* are the limits of both. If the least is above the greatest, there is no such pressure.
    """
    rest, (low, high), (least, most) = effort - one.a - two.a, within[0], within[1]
    first, second = (rest - two.b * least) / one.b, (rest - two.b * most) / one.b
    if second < first:
        first, second = second, first
    return max(low, first), min(high, second)


def stiffness_at(one: Line, two: Line, effort: float, p: float) -> float:
    """Return the stiffness with *effort* if the first muscle has *p* Pa."""
    return one.c + one.d * p + two.c + two.d * other(one, two, effort, p)
