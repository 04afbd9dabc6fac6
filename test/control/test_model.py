# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the controller takes for a joint, against the rig itself and equations of its own."""

import numpy as np
import pytest

from pam_ros.control.model import ControlModel
from pam_ros.effects import LengthOffset, Payload, PressureDependentDamping, ViscousFriction
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import statics
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.transmissions import Lever, Straight
from support import joints
from support.joint_models import UNEQUAL, pair

# One muscle --------------------------------------------------------------------------------------

EFFECTS = [
    Payload(mass=5.0),
    LengthOffset(offset=0.02),
    ViscousFriction(coefficient=40.0),
    PressureDependentDamping(inflating=3e-4, deflating=5e-4),
]


def test_the_inverse_is_one():
    model = ControlModel(single_muscle_joint(effects=[LengthOffset(offset=0.02)]))
    (muscle,) = model.at(0.03).muscles
    assert muscle.force(muscle.pressure_for(200.0)) == pytest.approx(200.0)
    slope = (muscle.force(301e3) - muscle.force(300e3)) / 1e3
    assert muscle.gain == pytest.approx(slope, rel=1e-9)


def test_gravity_is_the_weight_of_the_moved_mass_and_adds_no_stiffness():
    model = ControlModel(single_muscle_joint(effects=[Payload(mass=5.0)]))
    assert model.gravity(0.05) == model.weight == pytest.approx(25.0 * 9.80665)
    assert model.gravity_stiffness(0.05) == 0.0
    assert (model.arm, model.arms) == (1.0, 1.0)


# A pair ------------------------------------------------------------------------------------------

PAIR = ControlModel(pair())


@pytest.mark.parametrize('angle', [-0.4, 0.0, 0.3])
def test_torque_stiffness_and_damping_of_a_pair_are_those_of_the_equations(angle):
    p = (4.0, 3.0)
    pascal = (4e5, 3e5)
    assert PAIR.effort(pascal, angle) == pytest.approx(joints.torque(p, angle, UNEQUAL))
    assert PAIR.gravity(angle) == pytest.approx(joints.gravity(angle))
    assert PAIR.damping(pascal, angle, 0.5) == pytest.approx(joints.drag(p, angle, UNEQUAL))
    k = joints.R**2 * sum(
        strand.stiffness(each, y)
        for strand, each, y in zip(UNEQUAL, p, joints.ends(angle, UNEQUAL), strict=True)
    )
    assert PAIR.stiffness(pascal, angle) == pytest.approx(k)
    h = 1e-5
    slope = (joints.gravity(angle + h) - joints.gravity(angle - h)) / (2.0 * h)
    assert PAIR.gravity_stiffness(angle) == pytest.approx(slope, rel=1e-6)
    rate = 0.7
    net = joints.torque(p, angle, UNEQUAL) - joints.gravity(angle)
    net -= joints.drag(p, angle, UNEQUAL) * rate
    assert PAIR.pull(pascal, angle, rate) == pytest.approx(net)


def test_the_arms_of_a_pair_are_the_radius():
    assert PAIR.arm == pytest.approx(joints.R)
    assert PAIR.arms == pytest.approx(2.0 * joints.R)
    assert PAIR.weight == 0.0


# Other joints ------------------------------------------------------------------------------------

HUNG = Actuator(Muscle(zeta=0.15), [LengthOffset(offset=0.01)], 0.1)
OTHERS = {
    'one muscle': single_muscle_joint(Muscle(zeta=0.15), Mass(mass=20.0)),
    'its effects': single_muscle_joint(Muscle(zeta=0.15), Mass(mass=20.0), EFFECTS),
    'pair': pair(load=[ViscousFriction(coefficient=0.2), Payload(mass=0.4)]),
    'parallel': Joint((Actuator(), Actuator(Muscle(l0=0.38))), Mass(mass=40.0), Straight()),
    'lever': Joint((HUNG, HUNG), Arm(hanging_at=0.2), Lever()),
    'crank': Joint((HUNG,), Arm(hanging_at=-0.6), Lever(), [ViscousFriction(coefficient=0.1)]),
}


@pytest.mark.parametrize('v', [0.1, -0.1])
@pytest.mark.parametrize('name', OTHERS)
def test_the_model_of_every_joint_is_its_rig_without_memory(name, v):
    joint = OTHERS[name]
    model, rig = ControlModel(joint), Simulation([joint])
    n = len(joint.muscles)
    p, s = (3e5, 2.5e5)[:n], 0.02
    rig.reset(p, [s], [v])
    effort, stiffness, acceleration = np.ravel(rig.joint_outputs())
    assert model.effort(p, s) == pytest.approx(effort, rel=1e-9)
    assert model.stiffness(p, s) == pytest.approx(stiffness, rel=1e-9)
    net = (model.pull(p, s, v) - model.weight) / model.inertia
    assert net == pytest.approx(acceleration, rel=1e-9)
    if not joint.is_revolute:
        assert model.pull(p, s, v) == pytest.approx(effort - model.damping(p, s, v) * v, rel=1e-12)
    assert model.gravity(s) == pytest.approx(statics.weight(joint, s), rel=1e-12)
    # The stiffness is what the effort loses with the coordinate.
    h = 1e-6
    slope = (model.effort(p, s + h) - model.effort(p, s - h)) / (2.0 * h)
    assert model.stiffness(p, s) == pytest.approx(-slope, rel=1e-6)


@pytest.mark.parametrize('name', OTHERS)
def test_a_repeated_coordinate_gives_the_same_state(name):
    """One model is asked at several coordinates in turn, another one only once."""
    joint, places, p = OTHERS[name], (0.02, -0.01, 0.02, 0.02, 0.03), (3e5, 2.5e5)
    model, p = ControlModel(joint), p[: len(joint.muscles)]
    for s in places:
        fresh = ControlModel(joint)
        assert model.at(s).s == s
        assert model.at(s).gains == fresh.at(s).gains
        assert model.stiffness(p, s) == fresh.stiffness(p, s)
        assert model.damping(p, s, 0.1) == fresh.damping(p, s, 0.1)
        assert model.effort(p, s) == fresh.effort(p, s)
