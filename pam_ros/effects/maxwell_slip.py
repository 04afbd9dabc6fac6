# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Maxwell slip: elastic elements in parallel, each of which slips at its own threshold.

They are the complement of the play operators of Prandtl and Ishlinskii. They close every minor
loop and remember all turning points.
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

    They stick up to their thresholds, of which *width* is the greatest, and slip there.
    """
    mean = 0.0
    for n in range(ELEMENTS):
        d = width * threshold(n, onset, ratio)
        strain = min(max(x[i + n] + ds, -d), d)
        xn[i + n] = strain
        mean += strain / d
    return mean / ELEMENTS


def strains(share: float, width: float, onset: float, ratio: float) -> tuple[float, ...]:
    """Return the strains of all elements at a *share* of their thresholds, from -1 to 1."""
    of = plain(threshold)
    return tuple(share * width * of(n, onset, ratio) for n in range(ELEMENTS))
