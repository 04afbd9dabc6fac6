# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The force law of Sárosi (2015), its slope, its damping and its inverse, as scalar functions.

Everything is SI: gauge pressure p in Pa, contraction kappa as a fraction of l0 (positive when
the muscle shortens and lifts the load), force in N (positive when the muscle pulls). The
constants a1..a6 are the paper's, converted to these units by :mod:`pam_ros.muscle.constants`.

The paper takes x downwards and prints the bracket of (2) and (4) without a sign. The force
decreases with contraction. So this bracket, dF/dkappa, is negative for a working muscle, and (4)
as printed is the root of a negative number. The physical stiffness is minus the bracket over l0;
both functions below use it.

The functions are plain scalar Python, compiled for stepping if numba is installed. ``force_v`` and
so on are the same source broadcast over numpy arrays, for analysis.
"""

from math import exp, sqrt

from pam_ros.compiled import broadcast, scalar


@scalar
def force(
    p: float, kappa: float, a1: float, a2: float, a3: float, a4: float, a5: float, a6: float
) -> float:
    """Return the static pulling force in N: equation (1) of Sárosi (2015)."""
    return force_at(exp(a3 * kappa), p, kappa, a1, a2, a4, a5, a6)


@scalar
def force_at(
    e: float, p: float, kappa: float, a1: float, a2: float, a4: float, a5: float, a6: float
) -> float:
    """Return (1) for a known e = exp(a3 kappa), which the kernel also uses for the slope."""
    return (a1 * p + a2) * e + a4 * kappa * p + a5 * p + a6


@scalar
def slope(p: float, kappa: float, a1: float, a2: float, a3: float, a4: float) -> float:
    """Return dF/dkappa in N: the bracket of (2) and (4), negative for a working muscle."""
    return slope_at(exp(a3 * kappa), p, a1, a2, a3, a4)


@scalar
def slope_at(e: float, p: float, a1: float, a2: float, a3: float, a4: float) -> float:
    """Return dF/dkappa for a known e = exp(a3 kappa)."""
    return (a1 * p + a2) * a3 * e + a4 * p


@scalar
def stiffness(
    p: float, kappa: float, a1: float, a2: float, a3: float, a4: float, l0: float
) -> float:
    """Return k = -(dF/dkappa)/l0 in N/m: equation (2) with its sign corrected, positive."""
    return -slope_at(exp(a3 * kappa), p, a1, a2, a3, a4) / l0


@scalar
def damping(k: float, mass: float, zeta: float) -> float:
    """Return c = 2 zeta sqrt(m k) in N s/m: equation (4) with the corrected stiffness.

    If k is not positive, the muscle has no spring and (4) gives no damping: c is 0.
    A muscle with such a point in its working range is refused when it is created; only a force
    source is accepted, which has no spring and zeta 0.
    """
    return 2.0 * zeta * sqrt(mass * max(k, 0.0))


@scalar
def gain(kappa: float, a1: float, a3: float, a4: float, a5: float) -> float:
    """Return dF/dp in N/Pa: the force law is affine in p, and this is its slope."""
    return gain_at(exp(a3 * kappa), kappa, a1, a4, a5)


@scalar
def gain_at(e: float, kappa: float, a1: float, a4: float, a5: float) -> float:
    """Return dF/dp in N/Pa for a known e = exp(a3 kappa)."""
    return a1 * e + a4 * kappa + a5


@scalar
def pressure_for_force(
    wanted: float,
    kappa: float,
    a1: float,
    a2: float,
    a3: float,
    a4: float,
    a5: float,
    a6: float,
) -> float:
    """Return the gauge pressure in Pa at which equation (1) gives *wanted* N at *kappa*.

    It is explicit, since (1) is affine in p. It is valid if :func:`gain` is positive; the result
    is not clamped and may lie outside the muscle's pressure range.
    """
    e = exp(a3 * kappa)
    return pressure_at(e, wanted, gain_at(e, kappa, a1, a4, a5), a2, a6)


@scalar
def pressure_at(e: float, wanted: float, gain: float, a2: float, a6: float) -> float:
    """Return the pressure in Pa for *wanted* N, for a known e = exp(a3 kappa) and gain dF/dp."""
    return (wanted - a2 * e - a6) / gain


@scalar
def potential(
    p: float,
    kappa: float,
    a1: float,
    a2: float,
    a3: float,
    a4: float,
    a5: float,
    a6: float,
    l0: float,
) -> float:
    """Return the work in J that (1) does from kappa = 0 to *kappa* at constant pressure.

    This is the closed form of the integral of F dy, y = kappa l0; energy balances use it.
    """
    spring = (a1 * p + a2) * (exp(a3 * kappa) - 1.0) / a3 if a3 != 0.0 else (a1 * p + a2) * kappa
    return l0 * (spring + 0.5 * a4 * p * kappa * kappa + (a5 * p + a6) * kappa)


force_v = broadcast(force)
slope_v = broadcast(slope)
stiffness_v = broadcast(stiffness)
damping_v = broadcast(damping)
gain_v = broadcast(gain)
pressure_for_force_v = broadcast(pressure_for_force)
potential_v = broadcast(potential)
