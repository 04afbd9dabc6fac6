# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The names that are bound to a kind of joint and to the effects in use.

Here they are those of one muscle on a mass, without effects: so the templates of the kernel can
be run without compilation. :mod:`pam_ros.rig.bind` replaces them. The arguments are described in
:mod:`pam_ros.rig.kernel`.
"""

from typing import Any

from pam_ros.effects.base import ENOUGH
from pam_ros.rig.layout import JOINT_EFFECTS

Row = Any  # float64 array; numba's and numpy's types differ, both index to float

MUSCLES = 1
HAS_RESERVOIR = True  # whether an effect that limits the supply of air is in use
HAS_OUTSIDE = True  # whether an effect that acts from outside the muscles is in use
IS_DRAGGED = True  # whether an effect in use is measured by a machine that moves the joint
MEMORY_FROM = 1  # first hidden state of a muscle that is not in its pressure path
WIDTH = 2  # of a state
LOAD, TRANSMISSION = JOINT_EFFECTS, JOINT_EFFECTS + 1  # first indices of their numbers


def delay_chain(q: Row) -> float:
    """Return the delay of the commands in s: 0 without effects."""
    return 0.0


def reservoir_chain(taken: float, h: float, x: Row, xn: Row, q: Row) -> float:
    """Return the pressure of the supply after the chambers took *taken*: enough, without effects.

    x, xn and q are the rows of the joint.
    """
    return ENOUGH


def pressure_chain(p: float, t: float, h: float, x: Row, xn: Row, q: Row) -> float:
    """Return the chamber pressure at t: the upstream pressure, without effects."""
    return p


def contraction_chain(kappa: float, q: Row) -> float:
    """Return the effective contraction of the muscle, after its effects."""
    return kappa


def mass_chain(m: float, q: Row) -> float:
    """Return the moved mass."""
    return m


def force_chain(
    f: float, p: float, kappa: float, v: float, t: float, h: float, x: Row, xn: Row, q: Row
) -> float:
    """Return the muscle's force after its effects."""
    return f


def damping_chain(c: float, p: float, kappa: float, v: float, q: Row) -> float:
    """Return the muscle's damping coefficient after its effects."""
    return c


def outside_chain(
    f: float, p: float, s: float, v: float, t: float, h: float, x: Row, xn: Row, q: Row
) -> float:
    """Return the effort on the joint from outside the muscles."""
    return f


def drag_chain(
    f: float, p: float, s: float, v: float, t: float, h: float, x: Row, xn: Row, q: Row
) -> float:
    """Return the friction on the joint, without loads, as measured by a machine that moves it."""
    return f


def muscle_remembers(q: Row) -> bool:
    """Return whether a present effect in the muscle has a memory that is not a pressure."""
    return False


def joint_remembers(q: Row) -> bool:
    """Return whether a present effect on the joint has a memory."""
    return False


def travel_of(s: float, i: int, q: Row, j: int) -> float:
    """Return the displacement of the end of muscle i, contraction positive, 0 at s = 0."""
    return s


def arm_of(s: float, i: int, q: Row, j: int) -> float:
    """Return the arm of muscle i: its shortening per unit of the coordinate."""
    return 1.0


def arm_slope_of(s: float, i: int, q: Row, j: int) -> float:
    """Return the derivative of the arm with respect to s."""
    return 0.0


def inertia_of(m: float, q: Row, j: int) -> float:
    """Return the inertia of the coordinate."""
    return m


def fall_of(s: float, m: float, inertia: float, q: Row, j: int) -> float:
    """Return the gravitational acceleration, positive against the coordinate."""
    acceleration: float = q[j]
    return acceleration
