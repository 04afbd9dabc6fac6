# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A muscle at one place against the functions of the force law, each asked separately."""

from math import inf, sqrt

import pytest

from pam_ros.control.muscle_model import MuscleModel
from pam_ros.effects import LengthOffset, PressureDependentDamping, Slack
from pam_ros.muscle import law
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
from pam_ros.rig.transmissions import Lever

EFFECTS = [
    LengthOffset(offset=0.02),
    PressureDependentDamping(inflating=3e-4, deflating=5e-4),
    Slack(share=1.0, toe=20.0),
]
MUSCLE = Muscle(zeta=0.15)
JOINTS = {
    'mass': single_muscle_joint(MUSCLE),
    'mass, effects': single_muscle_joint(MUSCLE, effects=EFFECTS),
    'pair': antagonistic_joint(MUSCLE, Muscle(l0=0.38)),
    'pair, effects': antagonistic_joint(MUSCLE, effects=EFFECTS),
    'crank': Joint((Actuator(MUSCLE, (), 0.1),), Arm(), Lever()),
}
EACH = pytest.mark.parametrize('joint', JOINTS.values(), ids=JOINTS)
CASES = [(3e5, 0.02, 0.1), (1.5e5, -0.01, -0.2), (0.0, 0.03, 0.0)]  # p, s, v


@EACH
@pytest.mark.parametrize(('p', 's', 'v'), CASES)
def test_pull_is_force_and_damping_of_the_place_to_the_bit(joint, p, s, v):
    for i in range(len(joint.muscles)):
        model = MuscleModel(joint, i)
        place = model.at(s)
        damping = place.damping_on_joint(p, v, joint.inertia)
        assert model.pull(p, s, v, joint.inertia) == (place.arm * place.force(p), damping)


@pytest.mark.parametrize('name', ['mass', 'pair', 'crank'])
@pytest.mark.parametrize(('p', 's', 'v'), CASES)
def test_a_place_has_the_values_of_the_force_law(name, p, s, v):
    joint = JOINTS[name]
    geometry, numbers = joint.transmission.equations, joint.transmission.numbers
    for i, muscle in enumerate(joint.muscles):
        place = MuscleModel(joint, i).at(s)
        arm = geometry.arm(s, i, numbers, 0)
        kappa = (joint.at_zero[i] + geometry.travel(s, i, numbers, 0)) / muscle.l0
        a1, a2, a3, a4, a5, _ = a = muscle.si
        k = float(law.stiffness(p, kappa, a1, a2, a3, a4, muscle.l0))
        c = 2.0 * muscle.zeta * sqrt(joint.inertia / (len(joint.muscles) * arm**2) * k)
        assert (place.arm, place.kappa, place.contraction) == (arm, kappa, kappa)
        assert place.force(p) == pytest.approx(law.force(p, kappa, *a), rel=1e-14)
        assert place.gain == pytest.approx(law.gain(kappa, a1, a3, a4, a5), rel=1e-14)
        assert place.stiffness(p) == pytest.approx(k, rel=1e-14)
        found = law.pressure_for_force(50.0, kappa, *a)
        assert place.pressure_for(50.0) == pytest.approx(found, rel=1e-14)
        assert place.damping_on_joint(p, v, joint.inertia) == pytest.approx(arm**2 * c, rel=1e-12)
        assert place.slack_pressure() == -inf


def test_a_length_offset_moves_the_contraction_that_acts():
    place = MuscleModel(JOINTS['mass, effects'], 0).at(0.03)
    assert place.contraction == 0.03 / MUSCLE.l0
    assert place.kappa == pytest.approx(place.contraction + 0.02)


def test_below_the_slack_pressure_the_force_law_pushes():
    place = MuscleModel(JOINTS['mass, effects'], 0).at(0.06)
    p = place.slack_pressure()
    assert place.force_law(p) == pytest.approx(0.0, abs=1e-6)
    assert place.force(p - 2e5) == pytest.approx(0.0, abs=1e-6)
