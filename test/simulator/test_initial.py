# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The state in which a simulation starts: each joint at rest under its pressures, or not."""

import numpy as np

from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from pam_ros.simulator.initial import initial_state


def started(**given):
    given = {name.replace('__', '.'): value for name, value in given.items()}
    scene = Scene(given)
    setup = scene.build(checked(scene.table(), given))
    return setup, *initial_state(setup)


def test_each_of_many_muscles_rests_with_its_own_load():
    setup, pressure, position, velocity = started(
        muscles=[f'm{i}' for i in range(64)], m3__mass=9.0
    )
    assert pressure.shape == position.shape == velocity.shape == (64,)
    at_rest = [equilibrium(single_muscle_joint(), 0.0)] * 64
    at_rest[3] = equilibrium(setup.joints[3], 0.0)
    np.testing.assert_array_equal(position, at_rest)
    assert not velocity.any()


def test_a_pair_rests_under_its_own_pressures():
    setup, pressure, position, _ = started(
        joint='antagonistic', initial__pressure=2e5, pam_1__initial__pressure=3e5
    )
    np.testing.assert_array_equal(pressure, [3e5, 2e5])
    assert position[0] == equilibrium(setup.joints[0], (3e5, 2e5)) > 0.0


def test_a_lever_rests_where_its_muscles_hold_it():
    setup, _, position, _ = started(joint='lever', contraction_1=0.08, initial__pressure=2e5)
    np.testing.assert_array_equal(position, [equilibrium(setup.joints[0], 2e5)])


def test_a_joint_that_does_not_rest_has_the_position_and_velocity_that_are_given():
    _, pressure, position, velocity = started(
        muscles=['a', 'b'],
        initial__pressure=1e5,
        b__initial__at_rest=False,
        b__initial__position=0.03,
        b__initial__velocity=-0.2,
    )
    np.testing.assert_array_equal(pressure, [1e5, 1e5])
    assert position[1] == 0.03 != position[0]
    np.testing.assert_array_equal(velocity, [0.0, -0.2])
