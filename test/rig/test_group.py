# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints next to each other in one rig: each is to the bit what it is alone."""

import numpy as np
import pytest

from pam_ros.effects import CoulombFriction, Creep, DeadTime, Hysteresis, Payload, PressureLag
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support import joints, smooth_supply
from support.joint_models import BOTH_LONG, UNEQUAL, lever, muscle, pair, parallel
from support.joint_runs import MASS, run

LAG = [PressureLag(fill=0.05, vent=0.1)]
CREEP = [Creep(stiffness=300.0, time=0.5)]
IN_MUSCLE = [*CREEP, DeadTime(delay=0.0125)]
ON_LOAD = [CoulombFriction(level=0.5), Payload(mass=0.5)]
MIXED = (
    single_muscle_joint(effects=[*IN_MUSCLE, *ON_LOAD]),
    pair(effects=(IN_MUSCLE, ()), load=ON_LOAD),
    parallel(MASS, effects=((), IN_MUSCLE)),
    single_muscle_joint(load=Mass(mount='horizontal'), effects=[Hysteresis(slip=3.0)]),
    lever(effects=((), IN_MUSCLE), load=ON_LOAD),
    lever(UNEQUAL[:1], effects=(IN_MUSCLE,)),
    pair(BOTH_LONG, load=ON_LOAD, plane='horizontal'),
    single_muscle_joint(),
    single_muscle_joint(effects=[Payload(mass=3.0, onset=0.1)]),
)


def driven(models, commands):
    rig = Simulation(models)
    for row in commands:
        rig.command(row)
        rig.advance(37)
    return rig


def state(rig, joints_at, muscles_at):
    return np.concatenate(
        [
            rig.position[joints_at],
            rig.velocity[joints_at],
            *(each[joints_at] for each in rig.joint_outputs()),
            rig.pressure[muscles_at],
            rig.contraction[muscles_at],
            *(each[muscles_at] for each in rig.muscle_outputs()),
        ]
    )


# One kernel knows the effects of its own joints: another library has its own.
SWINGS = single_muscle_joint(
    effects=[smooth_supply.SmoothSupply(mean=3e5)], library=(smooth_supply.SmoothSupply,)
)
QUICK = single_muscle_joint(Muscle(zeta=0.3), Mass(mass=5.0), LAG)
RIGS = {
    'all kinds': MIXED,
    # Neighbours of one kind are stepped in one call; others in calls of their own.
    'sorted': sorted(MIXED, key=lambda joint: joint.transmission.equations.name),
    'plain': (single_muscle_joint(), pair(), lever(), lever(UNEQUAL[:1])),
    'equal': (single_muscle_joint(), single_muscle_joint()),
    'lag': (
        single_muscle_joint(),
        QUICK,
        single_muscle_joint(load=Mass(mount='horizontal'), effects=[*CREEP, *LAG]),
    ),
    'delay': (
        single_muscle_joint(load=Mass(mass=8.0), effects=IN_MUSCLE),
        QUICK,
        single_muscle_joint(),
    ),
    'libraries': (SWINGS, single_muscle_joint(), SWINGS),
}


@pytest.mark.parametrize('mixed', RIGS.values(), ids=RIGS)
def test_each_joint_of_a_group_moves_as_it_does_alone(mixed):
    """To the bit, with effects and without, whatever else is in the rig."""
    muscles = sum(len(joint.muscles) for joint in mixed)
    commands = np.random.default_rng(1).uniform(0.0, 6e5, (8, muscles))
    together = driven(mixed, commands)
    muscle_at = 0
    for i, joint in enumerate(mixed):
        n = len(joint.muscles)
        mine = slice(muscle_at, muscle_at + n)
        alone = driven([joint], commands[:, mine])
        expected = state(alone, slice(0, 1), slice(0, n))
        np.testing.assert_array_equal(state(together, slice(i, i + 1), mine), expected)
        muscle_at += n
    assert muscle_at == commands.shape[1]


def test_one_muscle_mounted_elsewhere_is_the_same_muscle():
    """A contraction at position 0 only moves where the position is counted from."""
    moved = Joint((Actuator(muscle(joints.LONG), (), 0.1),), Mass())
    t = np.linspace(0.0, 2.0, 201)
    there = run(single_muscle_joint(muscle(joints.LONG)), t, (0.06, 0.2), (3e5,))
    here = run(moved, t, (0.06 - 0.1 * joints.LONG.l0, 0.2), (3e5,))
    np.testing.assert_allclose(here[0] + 0.1 * joints.LONG.l0, there[0], atol=1e-12)
    np.testing.assert_allclose(here[1], there[1], atol=1e-11)
