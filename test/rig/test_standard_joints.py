# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The usual joints are those that their parts make."""

import pytest

from pam_ros.effects import EFFECTS, PressureLag, ViscousFriction
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
from pam_ros.rig.transmissions import Pulley, Straight

LAG = (PressureLag(fill=0.03, vent=0.05),)
FRICTION = (ViscousFriction(coefficient=0.1),)
SHORT = Muscle(l0=0.36)


def test_one_muscle_lifts_a_mass():
    made = single_muscle_joint(SHORT, Mass(mass=12.0), [*LAG, *FRICTION])
    assert made == Joint((Actuator(SHORT, LAG),), Mass(mass=12.0), Straight(), FRICTION)


def test_two_muscles_turn_a_pulley_with_an_arm():
    made = antagonistic_joint(
        SHORT, radius=0.03, load=Arm(mass=0.7), contraction=0.12, effects=[*LAG, *FRICTION]
    )
    muscle = Actuator(SHORT, LAG, 0.12)
    assert made == Joint((muscle, muscle), Arm(mass=0.7), Pulley(radius=0.03), FRICTION)


def test_by_default_both_muscles_are_the_papers():
    muscle = Actuator(contraction=0.1)
    assert antagonistic_joint() == Joint((muscle, muscle), Arm(), Pulley())


def test_the_first_muscle_turns_to_positive_angles_and_its_antagonist_back():
    made = antagonistic_joint(Muscle(), SHORT, contraction=(0.1, 0.08))
    assert made.muscles == (Muscle(), SHORT)
    assert [actuator.contraction for actuator in made.actuators] == [0.1, 0.08]
    angles = [equilibrium(made, p) for p in ((4e5, 2e5), (2e5, 4e5))]
    assert angles[0] > 0.0 > angles[1]


def test_both_take_a_library():
    library = tuple(effect for effect in EFFECTS if effect.name == 'pressure_lag')
    for make in (single_muscle_joint, antagonistic_joint):
        assert make(effects=LAG, library=library).library == library
        with pytest.raises(ParameterError, match=r'effects\.viscous_friction is not known'):
            make(effects=FRICTION, library=library)


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        ({'radius': 0.0}, r'radius = 0\.0 is not allowed: give 0.0001 to 1 m'),
        ({'contraction': (0.1, 0.1, 0.1)}, 'contraction'),
        ({'load': Mass()}, 'Pulley cannot move Mass'),
        ({'antagonist': 0.04}, r'muscle = 0\.04'),
    ],
)
def test_parts_that_do_not_go_together_are_refused(given, sentence):
    with pytest.raises(ParameterError, match=sentence):
        antagonistic_joint(**given)
