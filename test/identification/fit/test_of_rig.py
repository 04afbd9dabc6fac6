# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints with other numbers: in the matrix of a kernel as in a joint that is configured so."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import Payload, PressureLag
from pam_ros.errors import ParameterError
from pam_ros.identification.fit.of_rig import OfRig, changed, fill, numbers_of
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.transmissions import Lever, Pulley, Straight

ACTUATOR = Actuator(Muscle(), [PressureLag(fill=0.03)], contraction=0.1)
ARM = Arm(inertia=0.02, mass=1.5, arm=0.3, hanging_at=0.2)
JOINTS = {
    'load': single_muscle_joint(Muscle(), Mass(mass=12.0), [Payload(mass=2.0)]),
    'parallel': Joint((Actuator(Muscle()), Actuator(Muscle())), Mass(mass=12.0), Straight()),
    'antagonistic': Joint((ACTUATOR, ACTUATOR), ARM, Pulley(radius=0.04)),
    'lever': Joint((ACTUATOR, ACTUATOR), replace(ARM, mass=8.0), Lever()),
}
CASES = [(kind, of) for kind, joint in JOINTS.items() for of in numbers_of(joint)]


def test_the_numbers_of_each_kind_of_joint():
    names = {kind: {of.name for of in numbers_of(joint)} for kind, joint in JOINTS.items()}
    arm = {'inertia', 'mass', 'arm', 'hanging_at'}
    mounting = {'contraction_1', 'contraction_2'}
    assert names['load'] == {'mass'}
    assert names['parallel'] == {'mass', *mounting}
    assert names['antagonistic'] == {*arm, *mounting, 'radius'}
    assert names['lever'] == {*arm, *mounting, 'crank', 'anchor', 'angle'}


@pytest.mark.parametrize(('kind', 'of'), CASES, ids=[f'{kind} {of.name}' for kind, of in CASES])
def test_the_matrix_is_that_of_the_joint_with_the_other_number(kind, of):
    joint = JOINTS[kind]
    value, about = numbers_of(joint)[of]
    values = {of: 1.05 * value if value else 0.01}
    other = changed(joint, values)
    assert numbers_of(other)[of] == (values[of], about)
    q = joint.parameters()
    fill(q, joint, values)
    np.testing.assert_array_equal(q, other.parameters())
    assert np.any(q != joint.parameters())


def test_several_numbers_of_one_load_at_once():
    joint = JOINTS['antagonistic']
    inertia, mass = OfRig('inertia', 'load'), OfRig('mass', 'load')
    q = joint.parameters()
    fill(q, joint, {inertia: 0.05, mass: 3.0})
    expected = replace(joint, load=replace(ARM, inertia=0.05, mass=3.0))
    np.testing.assert_array_equal(q, expected.parameters())
    assert expected.inertia == pytest.approx(0.05 + 3.0 * 0.3**2, rel=1e-12)


def test_numbers_that_make_no_joint_are_refused():
    with pytest.raises(ParameterError, match='mass = 9000 kg'):
        changed(JOINTS['load'], {OfRig('mass', 'load'): 9000.0})
