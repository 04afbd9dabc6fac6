# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An unknown force over the position, as features: a spline whose slope is piecewise linear.

The force law of a rig differs from the nominal one by some percent of a muscle that comes from the
data sheet, and by a multiple near its rest length, where the force falls exponentially. The
slopes of the difference at evenly spaced knots over the reach are parameters. They act near their
knots alone, so that what was learned in one part of the reach changes nothing in another one; a
single slope would be extrapolated to the other end. The force is smooth, since its rate is
fed forward, too.
"""

from math import isfinite
from typing import NamedTuple

# With 5 the overshoots of a braided muscle are larger, 13 are no better; bench other_muscles.
KNOTS = 9


class Between(NamedTuple):
    """A position between the knots ``knot`` and ``knot`` + 1, with its share of the way."""

    knot: int
    share: float


class ForceCurve:
    """Features of a force over the position; the parameter of each is the slope at its knot.

    A feature is the integral over the position of the hat function of its knot, from the lower
    end of the reach, in units of *stroke*: a parameter is the change of the force over a *stroke*.
    Outside the reach the slope is that at its end. Without a finite reach there is one slope for
    all positions, which is the first parameter.
    """

    def __init__(self, reach: tuple[float, float], stroke: float) -> None:
        """Place the knots over the *reach* in m or rad, as the *stroke*."""
        self._low = reach[0]
        self._is_one = not (isfinite(reach[0]) and isfinite(reach[1]))
        self._width = 1.0 if self._is_one else (reach[1] - reach[0]) / (KNOTS - 1)
        self._stroke = stroke
        self._strokes = self._width / stroke  # between two knots

    def at(self, position: float) -> Between:
        """Return where the *position* is between the knots, at the ends if it is outside."""
        if self._is_one:
            return Between(0, 0.0)
        along = (position - self._low) / self._width
        if not along > 0.0:  # also if it is not a number, as are its features then
            return Between(0, 0.0)
        if along >= KNOTS - 1:
            return Between(KNOTS - 2, 1.0)
        knot = int(along)
        return Between(knot, along - knot)

    def features(self, position: float) -> list[float]:
        """Return the KNOTS features at *position*."""
        if self._is_one:
            return [position / self._stroke] + [0.0] * (KNOTS - 1)
        strokes = self._strokes
        knot, share = self.at(position)
        right = 0.5 * share * share
        values = [strokes] * knot
        values += [strokes * (0.5 + share - right), strokes * right]
        values += [0.0] * (KNOTS - 2 - knot)
        values[0] -= 0.5 * strokes  # the first knot has the right half of a hat alone
        outside = (position - self._low) / self._width - knot - share
        values[0 if outside < 0.0 else -1] += strokes * outside
        return values
