# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints with two muscles written once more, in the units of the muscles' source: bar and percent.

Nothing here uses the package. Angles in rad, positions in m, contraction positive.
"""

import math
from dataclasses import dataclass

from support import paper


@dataclass(frozen=True)
class Strand:
    """A muscle by its constants in bar and percent, and its length in m."""

    a: tuple[float, ...]
    l0: float

    def force(self, p, y):
        """Equation (1) at p bar and y m of contraction, N."""
        a1, a2, a3, a4, a5, a6 = self.a
        kappa = 100.0 * y / self.l0
        return (a1 * p + a2) * math.exp(a3 * kappa) + a4 * kappa * p + a5 * p + a6

    def stiffness(self, p, y):
        """-dF/dy, N/m."""
        a1, a2, a3, a4, _, _ = self.a
        kappa = 100.0 * y / self.l0
        return -((a1 * p + a2) * a3 * math.exp(a3 * kappa) + a4 * p) * 100.0 / self.l0


LONG = Strand((paper.A1, paper.A2, paper.A3, paper.A4, paper.A5, paper.A6), paper.L0)
# DMSP-20-200N, as config/muscles has it.
SHORT = Strand((-4.00180705, 292.4620246, -0.32930845, -9.33564098, 294.0538256, -280.498151), 0.2)

# An antagonistic pair: radius, inertia of the pulley, mass at the end of an arm, the angle at
# which it hangs, contractions at angle 0.
R, OF_PULLEY, M, ARM, HANGING_AT, KAPPA_1, KAPPA_2 = 0.03, 0.01, 1.5, 0.2, -0.4, 0.09, 0.12
J = OF_PULLEY + M * ARM**2
ZETA = 0.15


def ends(angle, strands):
    """Return the positions of both muscles' ends."""
    one, two = strands
    return KAPPA_1 * one.l0 + R * angle, KAPPA_2 * two.l0 - R * angle


def gravity(angle):
    """Return the torque by which the arm is pulled down."""
    return M * paper.G * ARM * math.sin(angle - HANGING_AT)


def torque(p, angle, strands):
    """Return what the muscles pull at p bar each."""
    (y1, y2), (one, two) = ends(angle, strands), strands
    return R * (one.force(p[0], y1) - two.force(p[1], y2))


def drag(p, angle, strands, zeta=ZETA):
    """Return the muscles' damping in N m s/rad: each moves half of the inertia, J / 2 r^2."""
    total = 0.0
    for pressure, y, strand in zip(p, ends(angle, strands), strands, strict=True):
        mass = J / (2.0 * R**2)
        total += R**2 * 2.0 * zeta * math.sqrt(mass * strand.stiffness(pressure, y))
    return total


def pair(p_of_t, strands, zeta=ZETA):
    """Return the right-hand side for scipy: state (angle, rate)."""

    def rhs(t, state):
        angle, rate = state
        p = p_of_t(t)
        c = drag(p, angle, strands, zeta) if zeta else 0.0
        return rate, (torque(p, angle, strands) - c * rate - gravity(angle)) / J

    return rhs


def parallel(p_of_t, strands, mass, offsets, zeta=ZETA):
    """Return the right-hand side of a mass that two muscles lift together: state (s, s')."""

    def rhs(t, state):
        s, v = state
        force = -mass * paper.G
        for p, strand, offset in zip(p_of_t(t), strands, offsets, strict=True):
            y = offset * strand.l0 + s
            c = 2.0 * zeta * math.sqrt(0.5 * mass * strand.stiffness(p, y))
            force += strand.force(p, y) - c * v
        return v, force / mass

    return rhs
