# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Constants of the force law, typed in from their published tables, and statics from them.

The law (Sarosi 2015, equation 1) with kappa = contraction / rest length:
F(p, kappa) = (a1 p + a2) exp(a3 kappa) + a4 kappa p + a5 p + a6.
"""

from __future__ import annotations

import math

GRAVITY = 9.81
P_MAX = 6.0e5

# p in bar, kappa in percent, F in newton, as the sources print them.
PUBLISHED = {
    'dmsp_20_400n': (-4.35573, 281.22370, -0.32866, -9.27035, 302.20107, -263.69185),
    'dmsp_20_200n': (
        -4.00180705,
        292.4620246,
        -0.32930845,
        -9.33564098,
        294.0538256,
        -280.498151,
    ),
    'dmsp_10': (-9.2194029, 203.7012413, -0.34221042, -3.2255991, 109.2038216, -208.372034),
    'dmsp_20_datasheet': (-13.28753, 274.69509, -0.26707, -8.10079, 266.25842, -276.47848),
}


def constants_si(muscle: str) -> tuple[float, ...]:
    """a1..a6 of a published muscle for p in Pa and kappa as a fraction."""
    a1, a2, a3, a4, a5, a6 = PUBLISHED[muscle]
    return (a1 / 1e5, a2, a3 * 100.0, a4 * 100.0 / 1e5, a5 / 1e5, a6)


def static_force(a: tuple[float, ...], p: float, kappa: float) -> float:
    """Return the static pull in N at p in Pa and kappa as a fraction."""
    a1, a2, a3, a4, a5, a6 = a
    return (a1 * p + a2) * math.exp(a3 * kappa) + a4 * kappa * p + a5 * p + a6


def pressure_for(a: tuple[float, ...], force: float, kappa: float) -> float:
    """Return the pressure in Pa that holds a force at a contraction (the law is affine in p)."""
    base = static_force(a, 0.0, kappa)
    return (force - base) / (static_force(a, 1.0, kappa) - base)


def contraction_for(a: tuple[float, ...], p: float, force: float) -> float:
    """Contraction at which the static pull equals a force, by bisection of the falling law."""
    low, high = -0.10, 0.45
    if not static_force(a, p, low) > force > static_force(a, p, high):
        raise ValueError(f'no contraction in [{low}, {high}] holds {force} N at {p} Pa')
    for _ in range(60):
        mid = 0.5 * (low + high)
        if static_force(a, p, mid) > force:
            low = mid
        else:
            high = mid
    return 0.5 * (low + high)
