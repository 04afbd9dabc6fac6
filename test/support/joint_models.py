# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The joints of ``support.joints`` as the package declares them."""

from pam_ros.rig.joint_model import Actuator, JointModel
from pam_ros.rig.joints.antagonistic_pair import PulleyArm
from pam_ros.rig.joints.parallel import ParallelLoad

from pam_ros.effects import EFFECTS
from pam_ros.muscle.muscle import Muscle
from support import joints

NAMES = ('a1', 'a2', 'a3', 'a4', 'a5', 'a6')
BOTH_LONG = (joints.LONG, joints.LONG)
UNEQUAL = (joints.LONG, joints.SHORT)


def muscle(strand, zeta=joints.ZETA):
    """Return a strand as a muscle."""
    return Muscle(**dict(zip(NAMES, strand.a, strict=True)), l0=strand.l0, zeta=zeta)


def actuators(strands, effects=({}, {}), zeta=joints.ZETA):
    return tuple(
        Actuator(muscle(strand, zeta), own) for strand, own in zip(strands, effects, strict=True)
    )


def arm(**changes):
    """Return the arm of ``support.joints`` with *changes*."""
    declared = {
        'radius': joints.R,
        'inertia': joints.OF_PULLEY,
        'mass': joints.M,
        'arm': joints.ARM,
        'hanging_at': joints.HANGING_AT,
        'contraction_1': joints.KAPPA_1,
        'contraction_2': joints.KAPPA_2,
    }
    return PulleyArm(**declared | changes)


def pair(strands=UNEQUAL, effects=({}, {}), zeta=joints.ZETA, library=EFFECTS, load=(), **changes):
    """Return the antagonistic pair; *effects* of each muscle, *load* those on the arm."""
    return JointModel(arm(**changes), actuators(strands, effects, zeta), dict(load), library)


def parallel(
    mass, strands=UNEQUAL, offsets=(0.0, 0.0), effects=({}, {}), zeta=joints.ZETA, load=()
):
    """Return a mass on two muscles."""
    hung = ParallelLoad(mass=mass, contraction_1=offsets[0], contraction_2=offsets[1])
    return JointModel(hung, actuators(strands, effects, zeta), dict(load))
