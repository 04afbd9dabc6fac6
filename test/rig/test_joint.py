# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What makes a joint, and what the kernel is given of it."""

import numpy as np
import pytest

from pam_ros.effects import (
    EFFECTS,
    CoulombFriction,
    DeadTime,
    Payload,
    PressureLag,
)
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import layout as at
from pam_ros.rig import statics
from pam_ros.rig.effect_values import split_effects
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import GRAVITY, Arm, Mass
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
from pam_ros.rig.transmissions import Lever, Pulley, Straight
from support import joints
from support.joint_models import UNEQUAL, lever, muscle, pair, parallel

SOURCE = Muscle(a1=0.0, a2=0.0, a3=0.0, a4=0.0, a5=1.0, a6=0.0, pressure_unit='Pa', zeta=0.0)
LAG = (PressureLag(fill=0.1, vent=0.2),)
RUB = (CoulombFriction(level=0.5),)
PAIR = {'load': Arm(), 'transmission': Pulley()}
TWO = (Actuator(contraction=0.1), Actuator(contraction=0.1))


def test_by_default_it_is_the_papers_rig():
    joint = Joint()
    assert joint == single_muscle_joint()
    assert (joint.muscle, joint.load) == (Muscle(), Mass())
    assert joint.transmission == Straight()
    assert (joint.present, joint.active, joint.all_present) == (((), ()), (), ())
    assert not joint.is_revolute
    assert not joint.is_driven


def test_two_muscles_and_a_pulley_are_a_pair_that_hangs():
    joint = Joint(TWO, **PAIR)
    assert joint.is_revolute
    assert equilibrium(joint, 3e5) == pytest.approx(0.0, abs=1e-12)
    assert joint.present == ((), (), ())
    assert joint.active == ()
    assert joint.at_zero == (0.1 * 0.4, 0.1 * 0.4)


def test_a_known_force_in_the_place_of_a_muscle_drives_it():
    assert single_muscle_joint(SOURCE, Mass(mount='horizontal')).is_driven
    assert not single_muscle_joint(muscle(joints.LONG)).is_driven


def test_an_unconfigured_payload_moves_and_weighs():
    joint = single_muscle_joint(effects=[Payload(mass=4.0)])
    assert joint.moved_mass == 24.0
    assert statics.weight(joint, 0.0) == pytest.approx(24.0 * GRAVITY)
    assert equilibrium(joint, 6e5) < equilibrium(single_muscle_joint(), 6e5)


# What is refused -------------------------------------------------------------------------------

ALONE = [
    (
        {'load': Mass(mass=5000.0)},
        'mass = 5000 kg and this muscle do not fit together: no equilibrium: at 0',
    ),
    (
        {'effects': {'dead_time': {'delay': 0.1}}},
        "effects = {'dead_time': {'delay': 0.1}} is not allowed: give a sequence, each item an ",
    ),
    ({'effects': [*LAG, PressureLag()]}, 'effects[1] is a second pressure_lag: give one of each'),
    (
        {'effects': RUB, 'library': (DeadTime,)},
        'effects.coulomb_friction is not known: give one of dead_time',
    ),
    (
        {'muscle': Muscle(contraction_unit='fraction')},
        'mass = 20 kg and this muscle do not fit together: no equilibrium: at 0 kPa the ',
    ),
]


@pytest.mark.parametrize(('parts', 'sentence'), ALONE)
def test_what_makes_no_rig_of_one_muscle_is_refused_with_a_sentence(parts, sentence):
    with pytest.raises(ParameterError) as error:
        single_muscle_joint(**parts)
    assert str(error.value).startswith(sentence)


REFUSED = [
    ({'actuators': ()}, 'a joint needs a muscle: actuators is empty'),
    (
        {'load': Mass()},
        'Pulley cannot move Mass: a prismatic load needs a transmission in m, a revolute load',
    ),
    ({'transmission': Straight()}, 'Straight cannot move Arm: a prismatic load needs'),
    (
        {'effects': RUB, 'library': (Payload,)},
        'effects.coulomb_friction is not known: give one of payload',
    ),
    (
        {'actuators': (Actuator(effects=LAG), Actuator()), 'library': (DeadTime,)},
        'effects.pressure_lag is not known: give one of dead_time',
    ),
    ({'effects': LAG}, 'effects.pressure_lag acts in a muscle: give it there'),
    (
        {'actuators': (Actuator(), Actuator(effects=RUB))},
        'effects.coulomb_friction acts on the load: give it there',
    ),
    (
        {'actuators': (Actuator(), Actuator(SOURCE))},
        'muscle 2 of this joint has no stiffness: a1, a2 and a4 are 0',
    ),
    (
        {'actuators': (Actuator(contraction=0.6), Actuator(contraction=0.1))},
        'the muscles of this joint are never within kappa_min and kappa_max at the same '
        'time: correct contraction_1, contraction_2 or the lengths l0',
    ),
    (
        {'load': Mass(mass=9000.0), 'transmission': Straight()},
        'mass = 9000 kg and these muscles do not fit together: no equilibrium: with 0 and 0 ',
    ),
    (
        {'transmission': Lever(angle=0.3)},
        'mass = 1 kg and these muscles do not fit together: no equilibrium: with ',
    ),
]


@pytest.mark.parametrize(('parts', 'sentence'), REFUSED)
def test_what_makes_no_joint_is_refused_with_a_sentence(parts, sentence):
    with pytest.raises(ParameterError) as error:
        Joint(**{'actuators': TWO, **PAIR, **parts})
    assert str(error.value).startswith(sentence)


def test_the_single_muscle_exists_only_for_one_muscle():
    with pytest.raises(ParameterError, match='this joint has 2 muscles, not one'):
        _ = pair().muscle


# Effects in and on it ---------------------------------------------------------------------------


def test_effects_are_active_together_as_soon_as_one_is_present():
    none = single_muscle_joint(effects=[DeadTime(delay=0.0)])
    assert (none.all_present, none.active) == ((), ())
    one = single_muscle_joint(effects=[DeadTime(delay=0.1), *LAG])
    assert [effect.name for effect in one.all_present] == ['dead_time', 'pressure_lag']
    assert one.active == one.library


def test_effects_of_one_muscle_are_split_by_where_they_act():
    joint = single_muscle_joint(effects=[*LAG, *RUB])
    assert (joint.actuators[0].effects, joint.effects) == (LAG, RUB)
    assert joint.all_effects == (*LAG, *RUB)
    assert [[effect.name for effect in row] for row in joint.present] == [
        ['coulomb_friction'],
        ['pressure_lag'],
    ]
    assert split_effects([*LAG, *RUB]) == (LAG, RUB)


# The kernel's parameters ------------------------------------------------------------------------


def test_rows_of_one_muscle_hold_everything_in_si():
    joint = single_muscle_joint(effects=LAG)
    q, layout = joint.parameters(), joint.layout
    np.testing.assert_array_equal(q[at.MUSCLE, at.A1 : at.A6 + 1], joint.muscle.si)
    np.testing.assert_array_equal(q[at.MUSCLE, [at.ZETA, at.L0, at.AT_ZERO]], [0.15, 0.4, 0.0])
    np.testing.assert_array_equal(q[at.JOINT, [at.INERTIA, at.LENGTH, at.MASS]], [20.0, 0.4, 20.0])
    assert q[at.JOINT, layout.load_at] == GRAVITY
    j = layout.parameter_at['pressure_lag']
    np.testing.assert_array_equal(q[at.MUSCLE, j : j + 2], [0.1, 0.2])
    assert q.shape == (2, layout.parameters)
    flat = single_muscle_joint(load=Mass(mount='horizontal'))
    assert flat.parameters()[at.JOINT, flat.layout.load_at] == 0.0


def test_rows_of_a_pair_hold_everything_in_si():
    joint = pair(effects=(LAG, ()), load=[*RUB, Payload(mass=0.5)])
    on_joint, one, two = joint.parameters()
    layout = joint.layout
    for row, strand, kappa in (
        (one, UNEQUAL[0], joints.KAPPA_1),
        (two, UNEQUAL[1], joints.KAPPA_2),
    ):
        np.testing.assert_array_equal(row[:6], muscle(strand).si)
        assert (row[at.ZETA], row[at.L0]) == (joints.ZETA, strand.l0)
        assert row[at.AT_ZERO] == kappa * strand.l0
    # The joint's lengths are angles, its inertia the configured one: effects reckon with these.
    inertia, length, mass = on_joint[[at.INERTIA, at.LENGTH, at.MASS]]
    assert (inertia, length, mass) == (pytest.approx(joints.J), 1.0, joints.M)
    load = on_joint[layout.load_at :][:4]
    np.testing.assert_array_equal(load, [joints.OF_PULLEY, joints.ARM, joints.HANGING_AT, GRAVITY])
    assert on_joint[layout.transmission_at] == joints.R
    np.testing.assert_array_equal(one[layout.parameter_at['pressure_lag'] :][:2], [0.1, 0.2])
    np.testing.assert_array_equal(two[layout.parameter_at['pressure_lag'] :][:2], [0.0, 0.0])
    assert on_joint[layout.parameter_at['coulomb_friction']] == 0.5
    assert joint.moved_mass == joints.M + 0.5
    assert joint.inertia == pytest.approx(joints.J + 0.5 * joints.ARM**2)
    assert [[e.name for e in each] for each in joint.present] == [
        ['payload', 'coulomb_friction'],
        ['pressure_lag'],
        [],
    ]
    assert joint.active == EFFECTS


def test_rows_of_a_lever_have_its_three_numbers():
    joint = lever()
    numbers = joint.parameters()[at.JOINT, joint.layout.transmission_at :][:3]
    np.testing.assert_array_equal(numbers, joints.GEOMETRY)


def test_a_load_that_slides_has_lengths_in_m():
    joint = parallel(50.0)
    row = joint.parameters()[at.JOINT]
    assert (row[at.INERTIA], row[at.LENGTH]) == (50.0, UNEQUAL[0].l0)
    assert joint.inertia == 50.0


@pytest.mark.parametrize('contraction', [5, -0.51, 0.91])
def test_a_contraction_that_no_muscle_has_is_refused_as_in_a_file(contraction):
    said = f'^contraction = {contraction} is not allowed: give -0.5 to 0.9 fraction$'
    with pytest.raises(ParameterError, match=said.replace('.', r'\.')):
        Actuator(contraction=contraction)
    with pytest.raises(ParameterError, match=r'^contraction = .* give -0\.5 to 0\.9 fraction$'):
        antagonistic_joint(contraction=contraction)


# Changes -----------------------------------------------------------------------------------------


def test_effects_are_added_where_they_act():
    bare, friction = antagonistic_joint(), CoulombFriction(level=0.5)
    lagging = bare.with_effects(*LAG, friction)
    assert [tuple(one.effects) for one in lagging.actuators] == [LAG, LAG]
    assert lagging.effects == (friction,)
    assert (lagging.muscles, lagging.load, lagging.library) == (bare.muscles, bare.load, EFFECTS)
    assert lagging == antagonistic_joint(effects=[*LAG, friction])
    assert bare.all_present == ()


def test_an_added_effect_replaces_one_of_its_class():
    joint = single_muscle_joint(effects=[*LAG, Payload(mass=2.0)])
    changed = joint.with_effects(PressureLag(fill=0.3))
    assert changed.all_effects == (PressureLag(fill=0.3), Payload(mass=2.0))
    assert joint.with_effects() == joint


def test_the_load_is_changed_by_its_parameters():
    joint = single_muscle_joint(effects=RUB)
    assert joint.with_load(mass=10.0) == single_muscle_joint(load=Mass(mass=10.0), effects=RUB)
    elbow = antagonistic_joint(load=Arm(mass=2.0, arm=0.3))
    assert elbow.with_load(arm=0.2).load == Arm(mass=2.0, arm=0.2)


@pytest.mark.parametrize(
    ('changed', 'sentence'),
    [
        (lambda joint: joint.with_load(mass=-1.0), 'mass = -1.0 is not allowed'),
        (
            lambda joint: joint.with_load(inertia=0.1),
            'inertia = 0.1 is not a parameter of Mass: give mass, mount',
        ),
        (lambda joint: joint.with_effects('friction'), 'effects.0. = .friction. is not allowed'),
        (lambda joint: joint.with_effects(*LAG, *LAG), 'is a second pressure_lag'),
        (lambda joint: joint.with_effects(LAG), 'an effect, such as'),
    ],
)
def test_changes_that_make_no_joint_are_refused(changed, sentence):
    with pytest.raises(ParameterError, match=sentence):
        changed(single_muscle_joint())
