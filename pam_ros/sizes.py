# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sizes of a rig, with which typical sizes and tuning numbers are those of this rig.

The effects state the typical sizes, the ranges and the starting values of their parameters for a
reference rig: a muscle of 0.4 m that pulls 1 kN at 0.6 MPa, on a prismatic joint. On a rig of
another size they have the same influence if forces, pressures and lengths are in proportion. The
proportions are powers of ten, since typical sizes are orders of magnitude. On a revolute joint the
sizes are scaled by the arm of its muscles, too.

The tuning numbers and default gains of the controllers were found for a muscle of this length and
pressure that pulls 1.8 kN. They follow the exact proportions to it, except for rigs of the same
order of magnitude as the reference rig, on which they are the same.
"""

from dataclasses import dataclass
from math import log10, prod

import numpy as np
from numpy.typing import NDArray

from pam_ros.rig import statics
from pam_ros.rig.joint import Joint
from pam_ros.units import ARM_POWER, powers

Array = NDArray[np.float64]
FORCE, PRESSURE, LENGTH = 1e3, 6e5, 0.4  # N, Pa and m, of the reference rig
TUNED_FORCE = 1.8e3  # N, pull of the muscle for which the controllers were tuned


@dataclass(frozen=True)
class Revolute:
    """A revolute joint: the mean arm of its muscles, and their mean length, both in m."""

    arm: float
    length: float

    def contraction(self, angle: Array) -> Array:
        """Return the contraction of a muscle that corresponds to an *angle* in rad."""
        return angle * self.arm / self.length

    def factor(self, unit: str) -> float:
        """Return the size on this joint of 1 *unit* on a prismatic joint.

        A force at the arm is a torque. A length along the motion is an angle, and so is a
        contraction of a muscle of this length.
        """
        if unit == 'fraction':
            return self.length / self.arm
        return float(self.arm ** ARM_POWER.get(unit, 0))


@dataclass(frozen=True)
class Sizes:
    """How many times as large as on the reference rig forces, pressures and lengths are."""

    force: float = 1.0
    pressure: float = 1.0
    length: float = 1.0

    def factor(self, unit: str) -> float:
        """Return the size on this rig of 1 *unit* on the reference rig.

        Times are the same on all rigs, and masses are in the proportion of their weights.
        """
        each = {'N': self.force, 'kg': self.force, 'Pa': self.pressure, 'm': self.length}
        return prod(each.get(symbol, 1.0) ** power for symbol, power in powers(unit).items())


REFERENCE = Sizes()


def sizes_of(joint: Joint) -> Sizes:
    """Return the sizes of *joint* in powers of ten, from the means of its muscles."""
    force, pressure, length = _means(joint)
    return Sizes(_decade(force / FORCE), _decade(pressure / PRESSURE), _decade(length / LENGTH))


def tuned_sizes_of(joint: Joint) -> Sizes:
    """Return the sizes of *joint* for tuning numbers: exact where :func:`sizes_of` is not 1."""
    force, pressure, length = _means(joint)
    found = sizes_of(joint)
    return Sizes(
        1.0 if found.force == 1.0 else force / TUNED_FORCE,
        1.0 if found.pressure == 1.0 else pressure / PRESSURE,
        1.0 if found.length == 1.0 else length / LENGTH,
    )


def _means(joint: Joint) -> tuple[float, float, float]:
    """Return the mean pull in N, highest pressure in Pa and length in m of the muscles."""
    muscles = joint.muscles
    pulls = [abs(float(muscle.force(muscle.p_max, 0.0))) for muscle in muscles]
    highest, lengths = [muscle.p_max for muscle in muscles], [muscle.l0 for muscle in muscles]
    return float(np.mean(pulls)), float(np.mean(highest)), float(np.mean(lengths))


def revolute_of(joint: Joint) -> Revolute | None:
    """Return the sizes for a revolute *joint*, None for a prismatic one."""
    if not joint.is_revolute:
        return None
    arm = float(np.mean(np.abs(statics.middle_arms(joint))))
    return Revolute(arm, float(np.mean([m.l0 for m in joint.muscles])))


def _decade(ratio: float) -> float:
    """Return the power of ten that is nearest to *ratio*, 1 if it is 0 or not finite."""
    if not 0.0 < ratio < np.inf:
        return 1.0
    return float(10.0 ** round(log10(ratio)))
