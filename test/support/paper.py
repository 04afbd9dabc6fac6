# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The paper's muscle and rig written once more, in the paper's own units and signs.

Nothing here uses the package: p in bar, kappa in percent, displacement x in m downwards from the
length at rest, as Sárosi (2015) has them, for the DMSP-20-400N. The sign under the root of
equation (4) is corrected, since the bracket is negative.
"""

import math

from scipy.integrate import solve_ivp

A1, A2, A3, A4, A5, A6 = -4.35573, 281.22370, -0.32866, -9.27035, 302.20107, -263.69185
L0 = 0.4
G = 9.80665


def force(p, kappa):
    """Equation (1), N."""
    return (A1 * p + A2) * math.exp(A3 * kappa) + A4 * kappa * p + A5 * p + A6


def bracket(p, kappa):
    """The bracket of equations (2) and (4): dF/dkappa in N per percent."""
    return (A1 * p + A2) * A3 * math.exp(A3 * kappa) + A4 * p


def stiffness(p, kappa):
    """Equation (2), N/m: the bracket is per percent of L0, and its sign is corrected."""
    return -bracket(p, kappa) / (L0 / 100.0)


def damping(p, kappa, mass, zeta):
    """Equation (4), N s/m."""
    return 2.0 * zeta * math.sqrt(mass / (L0 / 100.0) * -bracket(p, kappa))


def pendulum(p_of_t, mass, zeta, g=G):
    """Equation (3) as a right-hand side for scipy: state (x, x'), x in m downwards; p in bar."""

    def rhs(t, state):
        x, xd = state
        p, kappa = p_of_t(t), -100.0 * x / L0
        return xd, (-force(p, kappa) - damping(p, kappa, mass, zeta) * xd + mass * g) / mass

    return rhs


def spring(p, y):
    """Return force in N and stiffness in N/m at p Pa and a contraction of y m."""
    bar, percent = p / 1e5, 100.0 * y / L0
    return force(bar, percent), stiffness(bar, percent)


def moved(p, y, v, t, mass=20.0, zeta=0.15):
    """Return contraction m and velocity m/s at t (n,), at constant p Pa, by scipy's DOP853.

    From (y, v) at t[0].
    """
    result = solve_ivp(
        pendulum(lambda _: p / 1e5, mass, zeta),
        (t[0], t[-1]),
        [-y, -v],
        'DOP853',
        t_eval=t,
        rtol=1e-11,
        atol=1e-13,
    )
    return -result.y
