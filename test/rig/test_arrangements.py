# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Arrangements: joints that users choose by name, each of parts that go together."""

import numpy as np
import pytest

from pam_ros.errors import ParameterError
from pam_ros.rig import statics
from pam_ros.rig.arrangements import (
    ANTAGONISTIC,
    ARRANGEMENTS,
    CRANK,
    LEVER,
    arrangement_of,
)
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import GRAVITY, Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support import joints
from support.joint_models import BOTH_LONG, muscle, parallel


def made(kind):
    actuator = Actuator(contraction=kind.contraction)
    return Joint((actuator,) * kind.muscles, kind.load(), kind.transmission())


def test_a_joint_has_the_arrangement_of_its_parts():
    for kind in ARRANGEMENTS:
        assert arrangement_of(made(kind)) is kind
    assert arrangement_of(Joint((Actuator(),) * 3)) is None
    assert arrangement_of(Joint((Actuator(contraction=0.1),))) is None


def test_their_names_differ_and_their_texts_say_how_many_muscles():
    assert len({kind.name for kind in ARRANGEMENTS}) == len(ARRANGEMENTS)
    for kind in ARRANGEMENTS:
        expected = 'two muscles' if kind.muscles == 2 else 'muscle'
        assert expected in kind.text


@pytest.mark.parametrize('kind', ARRANGEMENTS, ids=lambda kind: kind.name)
def test_parts_go_together_and_rest_over_the_whole_range_of_pressures(kind):
    joint = made(kind)
    low, high = statics.span(joint)
    assert low < 0.0 < high
    for p in (0.0, 3e5, 6e5):
        s = equilibrium(joint, p)
        left = statics.effort(joint, p, s) - statics.weight(joint, s)
        assert left == pytest.approx(0.0, abs=1e-8)
        k = statics.stiffness(joint, p, s) + statics.weight_stiffness(joint, s)
        assert k > 0.0


@pytest.mark.parametrize('kind', [ANTAGONISTIC, LEVER], ids=lambda kind: kind.name)
def test_equal_muscles_against_each_other_rest_in_the_middle(kind):
    joint = made(kind)
    for p in (0.0, 2e5, 6e5):
        assert equilibrium(joint, p) == pytest.approx(0.0, abs=1e-12)
    one, other = equilibrium(joint, (4e5, 2e5)), equilibrium(joint, (2e5, 4e5))
    assert one == pytest.approx(-other, abs=1e-10)
    assert one > 0.1


def test_a_crank_is_raised_by_its_one_muscle():
    joint = made(CRANK)
    angles = [equilibrium(joint, p) for p in (0.0, 1e5, 2e5, 3e5)]
    assert np.all(np.diff(angles) > 0.1)


# Two muscles side by side ------------------------------------------------------------------------


def test_each_of_two_equal_muscles_carries_half_the_weight():
    rig = Simulation([parallel(50.0, BOTH_LONG)])
    rig.command(4e5)
    rig.advance(8000)
    for force in rig.muscle_outputs().force:
        assert force == pytest.approx(25.0 * GRAVITY, abs=1e-6)
    assert rig.joint_outputs().effort[0] == pytest.approx(50.0 * GRAVITY, abs=1e-6)


def test_it_rests_where_one_of_two_equal_muscles_rests_with_half_the_mass():
    one = single_muscle_joint(muscle(joints.LONG), Mass(mass=25.0))
    for p in (1e5, 4e5):
        assert equilibrium(parallel(50.0, BOTH_LONG), p) == pytest.approx(
            equilibrium(one, p), abs=1e-12
        )


def test_a_crank_with_a_load_that_no_muscle_lifts_is_refused():
    actuator = Actuator(contraction=CRANK.contraction)
    with pytest.raises(ParameterError, match='mass = 200 kg and this muscle do not fit together'):
        Joint((actuator,), CRANK.load(mass=200.0, hanging_at=-1.5), CRANK.transmission())
