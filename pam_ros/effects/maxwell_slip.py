# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Maxwell slip: elastic elements in parallel, each of which slips at its own threshold.

They are the complement of the play operators of Prandtl and Ishlinskii. They close every minor
loop and remember all turning points. Two effects have them: over contraction, and over pressure.
"""

from math import expm1, log

from pam_ros.compiled import plain, scalar
from pam_ros.effects.base import Row

ELEMENTS = 10
EVEN = 1.0  # the ratio with which the gaps between thresholds are equal
MOST = 2.5e3  # the greatest ratio


@scalar
def threshold(n: int, onset: float, ratio: float) -> float:
    """Return the threshold of element n as a share of the greatest one, from *onset* to 1.

    The gaps between thresholds grow geometrically, from 0 to 1 by *ratio*. With 1 they are equal;
    with 1/onset the thresholds themselves are a geometric series.
    """
    s = (n + 0.5) / ELEMENTS
    if ratio != EVEN:
        s = expm1(s * log(ratio)) / (ratio - 1.0)
    return onset + (1.0 - onset) * s


@scalar
def slipped(ds: float, width: float, onset: float, ratio: float, x: Row, i: int, xn: Row) -> float:
    """Return the mean of the elements after a displacement ds, in -1..1; x[i] and on are strains.

    Each sticks up to its threshold, *width* times :func:`threshold`, and slips there.
    """
    # Computed each by itself, as threshold() does, the powers of the ratio would be three quarters
    # of the cost of a simulation. power is ratio^s - 1.
    power, per_power = 0.0, 0.0
    if ratio != EVEN:
        power, per_power = expm1(log(ratio) * (0.5 / ELEMENTS)), 1.0 / (ratio - 1.0)
    growth = power * (power + 2.0)  # the power from one element to the next, less 1
    mean = 0.0
    for n in range(ELEMENTS):
        s = (n + 0.5) / ELEMENTS
        if ratio != EVEN:
            s = power * per_power
            power += growth * (power + 1.0)
        d = width * (onset + (1.0 - onset) * s)
        strain = min(max(x[i + n] + ds, -d), d)
        xn[i + n] = strain
        mean += strain / d
    return mean / ELEMENTS


def strains(share: float, width: float, onset: float, ratio: float) -> tuple[float, ...]:
    """Return the strains of all elements at a *share* of their thresholds, from -1 to 1."""
    of = plain(threshold)
    return tuple(share * width * of(n, onset, ratio) for n in range(ELEMENTS))
