# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The joints that users choose by name: muscles, transmission and load."""

from dataclasses import dataclass

from pam_ros.rig.joint import Joint
from pam_ros.rig.loads import Arm, Load, Mass
from pam_ros.rig.transmissions import Lever, Pulley, Straight, Transmission


@dataclass(frozen=True)
class Arrangement:
    """A combination of muscles, a transmission and a load.

    ``contraction`` is the default contraction of each muscle at the coordinate 0.
    ``has_mounting`` is whether a user can set another one. This is not possible for one muscle on
    a mass, whose coordinate is measured from the muscle's own length at rest.
    """

    name: str
    text: str
    muscles: int
    transmission: type[Transmission]
    load: type[Load]
    contraction: float = 0.0
    has_mounting: bool = True


LOAD = Arrangement(
    'load', 'each muscle has a load of its own', 1, Straight, Mass, has_mounting=False
)
PARALLEL = Arrangement('parallel', 'two muscles move one load', 2, Straight, Mass)
ANTAGONISTIC = Arrangement(
    'antagonistic', 'two muscles turn a pulley against each other', 2, Pulley, Arm, 0.1
)
LEVER = Arrangement('lever', 'two muscles turn a lever against each other', 2, Lever, Arm, 0.1)
CRANK = Arrangement('crank', 'one muscle turns a lever against its load', 1, Lever, Arm, 0.1)
ARRANGEMENTS = (LOAD, PARALLEL, ANTAGONISTIC, LEVER, CRANK)


def arrangement_of(joint: Joint) -> Arrangement | None:
    """Return the arrangement of *joint*; None if it is none of those, but made by a program."""
    return next((kind for kind in ARRANGEMENTS if _is_of(joint, kind)), None)


def _is_of(joint: Joint, kind: Arrangement) -> bool:
    return (
        type(joint.transmission) is kind.transmission
        and type(joint.load) is kind.load
        and len(joint.actuators) == kind.muscles
        and (kind.has_mounting or joint.actuators[0].contraction == 0.0)
    )
