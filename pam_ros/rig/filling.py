# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How the chambers of a joint fill from one reservoir, as templates of the kernel.

The arguments are those of :mod:`pam_ros.rig.kernel`; u are the commands of the muscles in Pa.
"""

from pam_ros.effects.base import ENOUGH
from pam_ros.rig.layout import JOINT, MUSCLE, P
from pam_ros.rig.unbound import MUSCLES, Row, pressure_chain, reservoir_chain

PRECISION = 1e-6  # Pa, of the pressure of a reservoir
TURNS = 100  # at most, of the search for it, which nearly always needs three


def taken(limit: float, u: Row, t: float, h: float, x: Row, xn: Row, q: Row) -> float:
    """Return the rises of the chambers in Pa that a reservoir of *limit* Pa feeds in h seconds.

    A chamber vents into the atmosphere as far as its command tells it to. If the reservoir has
    less, they are connected, and air flows back into it.
    """
    total = 0.0
    for i in range(MUSCLES):
        r = MUSCLE + i
        fed = pressure_chain(min(u[i], limit), t + h, h, x[r], xn[r], q[r])
        alone = fed if u[i] <= limit else pressure_chain(u[i], t + h, h, x[r], xn[r], q[r])
        total += fed - min(x[r, P], alone)
    return total


def supplied(u: Row, t: float, h: float, x: Row, xn: Row, q: Row) -> float:
    """Advance the reservoir by h seconds; return its pressure in Pa in the middle of this step.

    No chamber is filled beyond it. The chambers take the more, the higher it is, and it is the
    lower, the more they take: one pressure fulfils both. First the chambers that fill at once do
    so, and x receives their pressures and that of the reservoir; it is refilled from there on.
    Chambers with a lag follow with second order in h. One that fills at once has the pressure of
    the middle until the end of the step: this is of first order, and less than 30 Pa at 1 ms.
    """
    at_once = balanced(u, t, 0.0, x, xn, q)
    if at_once >= ENOUGH:
        return at_once
    total = taken(at_once, u, t, 0.0, x, xn, q)
    reservoir_chain(total, 0.0, x[JOINT], x[JOINT], q[JOINT])
    for i in range(MUSCLES):
        r = MUSCLE + i
        x[r, P] = pressure_chain(min(u[i], at_once), t, 0.0, x[r], xn[r], q[r])
    limit = balanced(u, t, 0.5 * h, x, xn, q)
    total = taken(limit, u, t, h, x, xn, q)
    reservoir_chain(total, h, x[JOINT], xn[JOINT], q[JOINT])
    return limit


def balanced(u: Row, t: float, h: float, x: Row, xn: Row, q: Row) -> float:
    """Return the pressure of the reservoir after h seconds in which it is the limit.

    By the method of Illinois: a false position whose retained end counts half.
    """
    high = found = reservoir_chain(0.0, h, x[JOINT], xn[JOINT], q[JOINT])
    if high >= ENOUGH:
        return high
    low = above = below = 0.0
    highest = u[0]
    for i in range(1, MUSCLES):
        highest = max(highest, u[i])
    for turn in range(TURNS):
        total = taken(found, u, t, h, x, xn, q)
        left = reservoir_chain(total, h, x[JOINT], xn[JOINT], q[JOINT])
        excess = found - left
        if abs(excess) <= PRECISION:
            return left
        if turn == 0:
            if highest <= min(high, left):
                return left  # what the chambers take does not depend on it
            above, low, found = excess, left, left
            continue
        if turn == 1:
            below = excess
        elif excess * above > 0.0:
            high, above, below = found, excess, 0.5 * below
        else:
            low, below, above = found, excess, 0.5 * above
        found = (low * above - high * below) / (above - below)
    return found
