# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The joints that users choose by name: muscles, their transmission and their load."""

from dataclasses import dataclass

from pam_ros.rig.loads import Arm, Load, Mass
from pam_ros.rig.transmissions import Lever, Pulley, Straight, Transmission


@dataclass(frozen=True)
class Arrangement:
    """Muscles, a transmission and a load that go together.

    ``contraction`` is what each muscle has at the coordinate 0 unless something else is declared;
    ``has_mounting`` says that something else can be: one muscle on a mass has its coordinate
    from its own length.
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
