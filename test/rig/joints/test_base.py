# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What all joints share: geometry that hangs together, units on loads that turn."""

import math

import numpy as np
import pytest

from pam_ros.effects import EFFECTS
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joints import JOINTS
from pam_ros.rig.joints.antagonistic_pair import JOINT as PAIR
from pam_ros.rig.joints.antagonistic_pair import PulleyArm
from pam_ros.rig.joints.base import acts_in_muscle, acts_on_load
from pam_ros.rig.joints.parallel import JOINT as PARALLEL
from pam_ros.rig.joints.parallel import ParallelLoad
from pam_ros.rig.model import Load

MUSCLES = (Muscle(l0=0.4), Muscle(l0=0.3))
DECLARED = {
    'mass': Load(mass=12.0),
    'parallel': ParallelLoad(mass=12.0, contraction_1=0.05, contraction_2=-0.01),
    'antagonistic_pair': PulleyArm(hanging_at=0.3, contraction_1=0.08, contraction_2=0.12),
}
EACH = pytest.mark.parametrize('joint', JOINTS, ids=[joint.name for joint in JOINTS])


def row(joint):
    return joint.row(DECLARED[joint.name], MUSCLES[: joint.muscles])


def test_there_is_a_declaration_for_each():
    assert {joint.name: joint.declared for joint in JOINTS} == {
        name: type(declared) for name, declared in DECLARED.items()
    }


@EACH
def test_the_row_begins_with_the_mass_of_the_load(joint):
    assert row(joint)[0] == DECLARED[joint.name].mass


@EACH
def test_the_arm_is_the_slope_of_the_position_and_never_nothing(joint):
    g, h = row(joint), 1e-6
    for i in range(joint.muscles):
        for s in (-0.3, 0.0, 0.7):
            slope = (joint.position(s + h, i, g) - joint.position(s - h, i, g)) / (2.0 * h)
            assert joint.arm(s, i, g) == pytest.approx(slope, rel=1e-8)
            assert joint.arm(s, i, g) != 0.0


@EACH
def test_the_coordinate_is_the_inverse_of_the_position(joint):
    g = row(joint)
    for i in range(joint.muscles):
        for s in (-0.3, 0.0, 0.7):
            assert joint.coordinate(joint.position(s, i, g), i, g) == pytest.approx(s, abs=1e-15)


@EACH
def test_the_slope_of_the_fall_is_that(joint):
    g, h, m = row(joint), 1e-6, 11.0
    j = joint.inertia(m, g)
    for s in (-0.3, 0.0, 0.7):
        slope = (joint.fall(s + h, m, j, g) - joint.fall(s - h, m, j, g)) / (2.0 * h)
        assert joint.fall_slope(s, m, j, g) == pytest.approx(slope, rel=1e-8, abs=1e-9)


def test_units_of_what_turns():
    assert (PAIR.unit, PAIR.effort_unit) == ('rad', 'N m')
    assert (PARALLEL.unit, PARALLEL.effort_unit) == ('m', 'N')


def described(effect, joint):
    return {p.name: (p.unit, p.low, p.high) for p in joint.on_load(effect).parameters}


def test_effects_on_a_load_that_turns_have_its_units():
    effects = {effect.name: effect for effect in EFFECTS}
    stop = described(effects['end_stop'], PAIR)
    assert stop['upper'] == stop['lower'] == ('rad', -math.pi, math.pi)
    assert stop['stiffness'][0] == 'N m/rad'
    friction = described(effects['coulomb_friction'], PAIR)
    assert [unit for unit, _, _ in friction.values()] == [
        'N m', 'N m', 'rad/s', 'N m/Pa', '', 'rad',
    ]  # fmt: skip
    assert described(effects['viscous_friction'], PAIR)['coefficient'][0] == 'N m s/rad'
    assert described(effects['payload'], PAIR)['mass'][0] == 'kg'  # at the end of the arm
    for effect in filter(acts_on_load, EFFECTS):
        assert PARALLEL.on_load(effect) is effect
        # Nothing else about it differs: its equations are the same.
        turned = PAIR.on_load(effect)
        assert (turned.outside, turned.mass, turned.start) == (
            effect.outside, effect.mass, effect.start,
        )  # fmt: skip


def test_no_effect_on_a_load_has_a_unit_that_is_not_translated():
    known = {'', 'kg', 'rad', 'rad/s', 'N m', 'N m/rad', 'N m s/rad', 'N m/Pa', 's/rad'}
    for effect in filter(acts_on_load, EFFECTS):
        assert {unit for unit, _, _ in described(effect, PAIR).values()} <= known, effect.name


def test_every_effect_acts_in_a_muscle_or_on_the_load():
    for effect in EFFECTS:
        assert acts_on_load(effect) != acts_in_muscle(effect), effect.name
    assert np.sum([acts_on_load(effect) for effect in EFFECTS]) == 4
