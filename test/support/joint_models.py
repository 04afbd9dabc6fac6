# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The joints of ``support.joints`` as the package declares them."""

from pam_ros.effects import EFFECTS
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.transmissions import Lever, Pulley, Straight
from support import joints

NAMES = ('a1', 'a2', 'a3', 'a4', 'a5', 'a6')
BOTH_LONG = (joints.LONG, joints.LONG)
UNEQUAL = (joints.LONG, joints.SHORT)


def muscle(strand, zeta=joints.ZETA):
    """Return a strand as a muscle."""
    return Muscle(**dict(zip(NAMES, strand.a, strict=True)), l0=strand.l0, zeta=zeta)


def actuators(strands, contractions, effects=((), ()), zeta=joints.ZETA):
    return tuple(
        Actuator(muscle(strand, zeta), own, contraction)
        for strand, own, contraction in zip(strands, effects, contractions, strict=True)
    )


# What is configured of the arm, of the pulley, and of how the muscles are mounted.
PAIR = {
    'radius': joints.R,
    'inertia': joints.OF_PULLEY,
    'mass': joints.M,
    'arm': joints.ARM,
    'hanging_at': joints.HANGING_AT,
    'contraction_1': joints.KAPPA_1,
    'contraction_2': joints.KAPPA_2,
}
OF_ARM = ('inertia', 'mass', 'arm', 'hanging_at')


def pair(strands=UNEQUAL, effects=((), ()), zeta=joints.ZETA, library=EFFECTS, load=(), **changes):
    """Return the antagonistic pair; *effects* of each muscle, *load* those on the arm."""
    arm = PAIR | changes
    pulley = Pulley(arm.pop('radius'))
    contractions = arm.pop('contraction_1'), arm.pop('contraction_2')
    muscles = actuators(strands, contractions, effects, zeta)
    return Joint(muscles, Arm(**arm), pulley, load, library)


def parallel(
    mass, strands=UNEQUAL, offsets=(0.0, 0.0), effects=((), ()), zeta=joints.ZETA, load=()
):
    """Return a mass on two muscles."""
    muscles = actuators(strands, offsets, effects, zeta)
    return Joint(muscles, Mass(mass=mass), Straight(), load)


def lever(
    strands=UNEQUAL,
    effects=((), ()),
    zeta=joints.ZETA,
    load=(),
    geometry=joints.GEOMETRY,
    contractions=(joints.KAPPA_1, joints.KAPPA_2),
    **changes,
):
    """Return a lever with as many muscles as there are *strands*, and the arm of the pair."""
    arm = {name: value for name, value in PAIR.items() if name in OF_ARM} | changes
    n = len(strands)
    muscles = actuators(strands, contractions[:n], effects[:n], zeta)
    return Joint(muscles, Arm(**arm), Lever(*geometry), load)
