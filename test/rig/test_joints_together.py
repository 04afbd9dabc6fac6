# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints of several kinds in one rig: each is to the bit what it is alone."""

import numpy as np
import pytest

from pam_ros.rig.joint import Actuator, Joint, one_muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.rig import Rig
from support import joints, smooth_supply
from support.joint_models import BOTH_LONG, UNEQUAL, lever, muscle, pair, parallel
from support.joint_runs import MASS, run

IN_MUSCLE = {'creep': {'stiffness': 300.0, 'time': 0.5}, 'dead_time': {'delay': 0.0125}}
ON_LOAD = {'coulomb_friction': {'level': 0.5}, 'payload': {'mass': 0.5}}
MIXED = (
    one_muscle(effects=IN_MUSCLE | ON_LOAD),
    pair(effects=(IN_MUSCLE, {}), load=ON_LOAD),
    parallel(MASS, effects=({}, IN_MUSCLE)),
    one_muscle(load=Mass(mount='horizontal'), effects={'hysteresis': {'slip': 3.0}}),
    lever(effects=({}, IN_MUSCLE), load=ON_LOAD),
    lever(UNEQUAL[:1], effects=(IN_MUSCLE,)),
    pair(BOTH_LONG, load=ON_LOAD, plane='horizontal'),
    one_muscle(),
)


def driven(models, commands):
    rig = Rig(models)
    for row in commands:
        rig.command(row)
        rig.advance(37)
    return rig


def state(rig, joints_at, muscles_at):
    return np.concatenate(
        [
            rig.position[joints_at],
            rig.velocity[joints_at],
            rig.joint_outputs()[joints_at].ravel(),
            rig.pressure[muscles_at],
            rig.contraction[muscles_at],
            rig.outputs()[muscles_at].ravel(),
        ]
    )


def assert_each_is_what_it_is_alone(mixed, commands):
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


def test_joints_of_all_kinds_together_are_each_what_it_is_alone():
    """To the bit, with effects and without, whatever stands beside them in the rig."""
    commands = np.random.default_rng(1).uniform(0.0, 6e5, (8, 12))
    assert_each_is_what_it_is_alone(MIXED, commands)


def test_the_order_of_the_joints_does_not_matter():
    """Neighbours of one kind are stepped in one call; others in calls of their own."""
    commands = np.random.default_rng(3).uniform(0.0, 6e5, (8, 12))
    ordered = sorted(MIXED, key=lambda joint: joint.transmission.equations.name)
    assert_each_is_what_it_is_alone(ordered, commands)


def test_plain_joints_beside_each_other_are_what_they_are_alone_to_the_bit():
    commands = np.random.default_rng(2).uniform(0.0, 6e5, (8, 6))
    plain = (one_muscle(), pair(), lever(), lever(UNEQUAL[:1]))
    assert_each_is_what_it_is_alone(plain, commands)


@pytest.mark.slow
def test_joints_with_other_effects_to_choose_from_stand_beside_each_other():
    """Each kernel knows the effects of its own joints."""
    swings = one_muscle(effects={'smooth_supply': {'mean': 3e5}}, library=(smooth_supply.EFFECT,))
    commands = np.random.default_rng(4).uniform(0.0, 6e5, (8, 3))
    assert_each_is_what_it_is_alone((swings, one_muscle(), swings), commands)


def test_one_muscle_mounted_elsewhere_is_the_same_muscle():
    """A contraction at position 0 only moves where the position is counted from."""
    moved = Joint((Actuator(muscle(joints.LONG), {}, 0.1),), Mass())
    t = np.linspace(0.0, 2.0, 201)
    there = run(one_muscle(muscle(joints.LONG)), t, (0.06, 0.2), (3e5,))
    here = run(moved, t, (0.06 - 0.1 * joints.LONG.l0, 0.2), (3e5,))
    np.testing.assert_allclose(here[0] + 0.1 * joints.LONG.l0, there[0], atol=1e-12)
    np.testing.assert_allclose(here[1], there[1], atol=1e-11)
