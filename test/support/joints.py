# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints written once more, in the units of the muscles' source: bar and percent.

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


# A lever instead of the pulley: length of the crank, distance of the anchors from the pivot, and
# the angle between both at angle 0. The crank and both anchors are points in a plane.
GEOMETRY = CRANK, ANCHOR, AT_0 = 0.035, 0.4, 1.5


def line(angle, i, geometry=GEOMETRY):
    """Return the distance from the anchor of muscle i to the end of its crank, both as points.

    A positive angle turns the crank of the first muscle towards its anchor, that of the second
    away from it.
    """
    crank, anchor, at_0 = geometry
    phi = at_0 - (-1) ** i * angle
    return math.hypot(crank * math.cos(phi) - anchor, crank * math.sin(phi))


def drawn(angle, i, geometry=GEOMETRY):
    """Return how far muscle i has been drawn at an angle."""
    return line(0.0, i, geometry) - line(angle, i, geometry)


def lever_arm(angle, i, geometry=GEOMETRY):
    """Return the distance of the pivot from the line of muscle i: a cross product, with a sign."""
    crank, anchor, at_0 = geometry
    phi = at_0 - (-1) ** i * angle
    x, y = crank * math.cos(phi), crank * math.sin(phi)
    area = x * (0.0 - y) - y * (anchor - x)  # of the crank and the way from its end to the anchor
    return -((-1) ** i) * area / line(angle, i, geometry)


def lever_torque(p, angle, strands, kappas=(KAPPA_1, KAPPA_2)):
    """Return what the muscles pull the lever with at p bar each."""
    total = 0.0
    for i, (pressure, strand) in enumerate(zip(p, strands, strict=True)):
        y = kappas[i] * strand.l0 + drawn(angle, i)
        total += lever_arm(angle, i) * strand.force(pressure, y)
    return total


def lever_drag(p, angle, strands, zeta=ZETA, kappas=(KAPPA_1, KAPPA_2)):
    """Return the muscles' damping in N m s/rad: of n muscles each moves J / (n r^2)."""
    total = 0.0
    for i, (pressure, strand) in enumerate(zip(p, strands, strict=True)):
        r, y = lever_arm(angle, i), kappas[i] * strand.l0 + drawn(angle, i)
        mass = J / (len(strands) * r**2)
        total += r**2 * 2.0 * zeta * math.sqrt(mass * strand.stiffness(pressure, y))
    return total


def lever(p_of_t, strands, zeta=ZETA):
    """Return the right-hand side for scipy: state (angle, rate), one muscle or two."""

    def rhs(t, state):
        angle, rate = state
        p = p_of_t(t)
        c = lever_drag(p, angle, strands, zeta) if zeta else 0.0
        net = lever_torque(p, angle, strands) - c * rate - gravity(angle)
        return rate, net / J

    return rhs
