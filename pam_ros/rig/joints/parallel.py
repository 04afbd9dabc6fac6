# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A mass on two muscles in parallel, which both pull it the same way.

The equations, with s = 0 where the muscles have their stated contractions kappa_i:

    m s'' = F_1 - c_1 s' + F_2 - c_2 s' + outside - m g,    y_i = kappa_i l0_i + s
"""

from dataclasses import dataclass, replace

from pam_ros.muscle.muscle import Muscle
from pam_ros.parameters import parameter
from pam_ros.rig.joints import mass
from pam_ros.rig.joints.base import Row
from pam_ros.rig.model import Load


@dataclass(frozen=True)
class ParallelLoad(Load):
    """The mass that two muscles move together, its mount, and how they are hung up.

    The position is 0 where the muscles have their stated contractions.
    """

    contraction_1: float = parameter(
        0.0, 'contraction of the first muscle at position 0', 'fraction', low=-0.5, high=0.9
    )
    contraction_2: float = parameter(
        0.0, 'contraction of the second muscle at position 0', 'fraction', low=-0.5, high=0.9
    )


def row(load: ParallelLoad, muscles: tuple[Muscle, ...]) -> tuple[float, ...]:
    """Return mass in kg, gravity in m/s^2, and both muscles' positions at s = 0 in m."""
    first, second = muscles
    y1, y2 = load.contraction_1 * first.l0, load.contraction_2 * second.l0
    return load.mass, load.gravity, y1, y2


def position(s: float, i: int, g: Row) -> float:
    """Return s from where the muscle is hung up."""
    y: float = g[2 + i] + s
    return y


def coordinate(y: float, i: int, g: Row) -> float:
    """Return the load's position."""
    s: float = y - g[2 + i]
    return s


JOINT = replace(
    mass.JOINT,
    name='parallel',
    text='a mass that two muscles pull the same way',
    muscles=2,
    declared=ParallelLoad,
    row=row,
    position=position,
    coordinate=coordinate,
)
