# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints and muscles of files, for programs: those of ``pam_sim``, of every kind."""

from dataclasses import replace
from pathlib import Path

import pytest

from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.arrangements import ARRANGEMENTS
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
from pam_ros.rig.transmissions import Lever
from pam_ros.settings.load import load_joint, load_muscle
from pam_ros.settings.nominal import nominal_joint
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from support.by_name import by_name

ANTAGONISTIC = Path(__file__).parents[2] / 'config' / 'antagonistic.yaml'
SLACK = {'effects.slack.share': 1.0}
LARGE, SMALL = 'dmsp_20_400n', 'dmsp_10'


def plain(joint):
    """Return a joint whose muscles have no text on their source."""
    muscles = (replace(one, muscle=replace(one.muscle, source='')) for one in joint.actuators)
    return replace(joint, actuators=tuple(muscles))


# Joints -----------------------------------------------------------------------------------------


def test_a_muscle_of_the_package_lifts_its_mass():
    assert plain(load_joint(LARGE)) == single_muscle_joint()


def test_keywords_replace_values_of_the_file():
    assert plain(load_joint(LARGE, mass=10, zeta=0.2)) == single_muscle_joint(
        Muscle(zeta=0.2), Mass(mass=10.0)
    )


def test_a_file_of_an_antagonistic_joint_makes_one():
    assert load_joint(ANTAGONISTIC) == antagonistic_joint(load=Arm(mass=1.0, arm=0.25))
    small = load_joint(str(ANTAGONISTIC), SLACK, muscle=SMALL, radius=0.02)
    assert small == antagonistic_joint(
        load_muscle(SMALL),
        radius=0.02,
        load=Arm(mass=1.0, arm=0.25),
        effects=small.actuators[0].effects,
    )
    assert by_name(small.actuators[0].effects)['slack'].share == 1.0
    assert list(by_name(small.actuators[0].effects)) == ['slack']


@pytest.mark.parametrize('kind', [kind.name for kind in ARRANGEMENTS])
def test_every_kind_is_the_joint_that_is_simulated(kind):
    given = {'joint': kind, 'muscle': SMALL, 'mass': 1.0, **SLACK}
    scene = Scene(given)
    (simulated,) = scene.build(checked(scene.table(), given)).joints
    made = load_joint(SMALL, SLACK, joint=kind, mass=1.0)
    assert made.parameters().tobytes() == simulated.parameters().tobytes()
    assert made.layout == simulated.layout


def test_of_a_muscles_file_the_load_does_not_count_for_another_joint():
    crank = load_joint(SMALL, joint='crank', angle=2.0, contraction_1=0.0)
    assert crank == Joint((Actuator(load_muscle(SMALL)),), Arm(), Lever(angle=2.0))


def test_muscles_that_differ_have_values_of_their_own(file):
    path = file('joint: antagonistic, muscles: [flexor, extensor], extensor.l0: 0.3, zeta: 0.2')
    assert [muscle.l0 for muscle in load_joint(path).muscles] == [0.4, 0.3]
    changed = load_joint(path, {'flexor.zeta': 0.3})
    assert [muscle.zeta for muscle in changed.muscles] == [0.3, 0.2]


def test_a_name_of_another_program_in_a_file_is_passed_over(file):
    path = file('mass: 7, robot_name: arm, publish_rate: 100.0, sensor.latency: 0.01')
    assert load_joint(path) == single_muscle_joint(load=Mass(mass=7.0))


def test_an_identified_file_makes_the_same_joint(file):
    path = file('mass: 7, effects.coulomb_friction.level: 12')
    expected = nominal_joint(path).joint
    assert load_joint(path).parameters().tobytes() == expected.parameters().tobytes()


@pytest.mark.parametrize(
    ('values', 'parameters', 'sentence'),
    [
        ({}, {'masss': 3.0}, r'^masss is not a parameter: was mass meant\?$'),
        ({}, {'radius': 0.1}, r'^radius is not a parameter of joint = load: give one such as '),
        ({}, {'physics_rate': 1e4}, r'^physics_rate is a parameter of pam_sim, not of a joint'),
        ({}, {'mass': 'a'}, r"^mass = 'a' is not allowed: give a number, above 0 and at most 1"),
        ({}, {'joint': 'elbow'}, r"^joint = 'elbow' is not allowed: give one of load, parallel"),
        ({}, {'muscles': ['a', 'b']}, r'^dmsp_20_400n describes 2 joints, a, b: give a file '),
        ({'effects.slak.share': 1.0}, {}, r'^effects\.slak is not known: was slack or '),
        (['mass=10'], {}, r"^values = \['mass=10'\] is not allowed: give values by the names"),
    ],
)
def test_what_is_not_a_parameter_of_the_joint_is_refused(values, parameters, sentence):
    with pytest.raises(ParameterError, match=sentence):
        load_joint(LARGE, values, **parameters)


def test_a_mistyped_name_is_refused_with_its_file(file):
    with pytest.raises(ParameterError, match=r'given\.yaml: mas is not a parameter: was mass '):
        load_joint(file('mas: 7'))
    with pytest.raises(ParameterError, match=r'given\.yaml: effects\.magic is not known'):
        load_joint(file('effects.magic.gain: 1'))


@pytest.mark.parametrize(
    ('values', 'sentence'),
    [
        ('initial.nosuch: 1.0', 'initial.nosuch'),
        ('joint: antagonistic, muscles: [only]', 'muscles'),
    ],
)
def test_an_error_in_the_names_of_a_file_names_the_file(file, values, sentence):
    with pytest.raises(ParameterError, match=rf'^.*given\.yaml: .*{sentence}'):
        load_joint(file(values))


def test_an_error_in_the_names_of_overrides_does_not_name_the_file(file):
    path = file('joint: antagonistic')
    with pytest.raises(ParameterError, match=r'^muscles'):
        load_joint(path, muscles=('only',))


# Muscles ----------------------------------------------------------------------------------------


def test_a_muscle_is_that_of_the_joint():
    assert load_muscle(SMALL) == load_joint(SMALL).muscle
    assert load_muscle(ANTAGONISTIC) == Muscle()


def test_muscles_that_differ_are_not_one(file):
    path = file('joint: antagonistic, muscles: [flexor, extensor], extensor.l0: 0.3')
    with pytest.raises(ParameterError, match='describes muscles that differ, flexor, extensor: '):
        load_muscle(path)


def test_a_muscle_that_is_not_there_is_refused_with_those_that_are():
    with pytest.raises(ParameterError, match=r'^dmsp_100 is neither .* one of dmsp_10, '):
        load_muscle('dmsp_100')
    with pytest.raises(ParameterError, match=r'^name = 3 is not allowed: give a path'):
        load_muscle(3)
