# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Maxwell slip: elastic elements in parallel, each of which slips at its own threshold.

Each element is a stop operator, the complement of a play operator of Prandtl and Ishlinskii. With
them every minor loop is closed, and all turning points are stored. Two effects use them: one over
contraction, and one over pressure.
"""

from math import expm1, log

from pam_ros.compiled import plain, scalar
from pam_ros.effects.base import Row

ELEMENTS = 10
EVEN = 1.0  # ratio for equal gaps between the thresholds
MOST = 2.5e3  # largest ratio
# In the symbols of the parameters of both effects, over their displacement x.
EQUATION = (
    f'  m = mean(e_n / d_n) of {ELEMENTS} elements, with de_n/dt = dx/dt within |e_n| <= d_n\n'
    '  d_n = slip_width (slip_onset + (1 - slip_onset) r_n)\n'
    '  r_n = (slip_ratio^c_n - 1) / (slip_ratio - 1), or c_n with slip_ratio = 1\n'
    f'  c_n = (n - 0.5) / {ELEMENTS}'
)


@scalar
def threshold(n: int, onset: float, ratio: float) -> float:
    """Return the threshold of element n as a share of the largest one, from *onset* to 1.

    The gaps between thresholds grow geometrically, by the factor *ratio* from the first to the
    last. With 1 they are equal; with 1/onset the thresholds are a geometric series.
    """
    s = (n + 0.5) / ELEMENTS
    if ratio != EVEN:
        s = expm1(s * log(ratio)) / (ratio - 1.0)
    return onset + (1.0 - onset) * s


@scalar
def slipped(ds: float, width: float, onset: float, ratio: float, x: Row, i: int, xn: Row) -> float:
    """Return the mean of the elements' forces, in -1..1, after a displacement ds.

    x[i] is the strain of the first element, the others follow. Each element sticks up to its
    threshold, which is *width* times :func:`threshold`, and slips there.
    """
    # power is ratio^s - 1. It is computed from that of the element before: with one power for each
    # element, as in threshold(), these would be three quarters of the cost of a simulation.
    power, per_power = 0.0, 0.0
    if ratio != EVEN:
        power, per_power = expm1(log(ratio) * (0.5 / ELEMENTS)), 1.0 / (ratio - 1.0)
    growth = power * (power + 2.0)  # ratio^(1 / ELEMENTS) - 1, from one element to the next
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
    """Return the strains of all elements if each is at a *share*, -1 to 1, of its threshold."""
    of = plain(threshold)
    return tuple(share * width * of(n, onset, ratio) for n in range(ELEMENTS))
