# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Two muscles on one coordinate: the pressures for an effort and a stiffness, in closed form.

At a coordinate, muscle i gives the effort a_i + b_i p_i and the stiffness c_i + d_i p_i. Both
wanted together are two linear equations for two pressures. Pressures that give the effort alone
are on a line, of which limits of pressure cut out a piece: along it the stiffness changes, and its
ends are the least and the greatest that can be had. Scalars, SI.
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
        """Pressure in Pa below which the law lets the muscle push."""
        return -self.a / self.b


def is_settled(one: Line, two: Line) -> bool:
    """Say whether the effort settles the stiffness: alike muscles that pull the same way."""
    left, right = one.b * two.d, two.b * one.d
    return abs(left - right) < 1e-9 * (abs(left) + abs(right))


def pressures(one: Line, two: Line, effort: float, stiffness: float) -> tuple[float, float]:
    """Return the pressures in Pa that give both, whatever the limits."""
    tau, k = effort - one.a - two.a, stiffness - one.c - two.c
    scale = one.b * two.d - two.b * one.d
    return (tau * two.d - k * two.b) / scale, (k * one.b - tau * one.d) / scale


def other(one: Line, two: Line, effort: float, p: float) -> float:
    """Return the pressure of the second muscle that gives *effort* where the first has *p* Pa."""
    return (effort - one.a - two.a - one.b * p) / two.b


def piece(one: Line, two: Line, effort: float, within: tuple[Limits, Limits]) -> Limits:
    """Return the least and greatest pressure of the first muscle that can be had with *effort*.

    *within* are the limits of both. Where the first is above the second there is no such pressure.
    """
    ends = sorted((effort - one.a - two.a - two.b * p) / one.b for p in within[1])
    return max(within[0][0], ends[0]), min(within[0][1], ends[1])


def stiffness_at(one: Line, two: Line, effort: float, p: float) -> float:
    """Return the stiffness with *effort* where the first muscle has *p* Pa."""
    return one.c + one.d * p + two.c + two.d * other(one, two, effort, p)
