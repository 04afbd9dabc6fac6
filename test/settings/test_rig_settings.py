# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The way from flat values, of a file or of a program, to joints."""

from pathlib import Path

import pytest

from pam_ros.effects import EFFECTS, CoulombFriction
from pam_ros.errors import ParameterError
from pam_ros.rig.arrangements import LOAD
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.settings.nominal import NominalJoint, nominal_joint
from pam_ros.settings.rig import RigParameters
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked, rig_table

ROOT = Path(__file__).parents[2]
MUSCLES = sorted(path.stem for path in (ROOT / 'config' / 'muscles').glob('*.yaml'))
RUB = [CoulombFriction(level=12.0)]
RUBS = 'effects.coulomb_friction.level'


def built(values, **given):
    return RigParameters(given).build_joints(values)


# Joints of flat values -------------------------------------------------------------------------


def test_defaults_make_the_default_rig():
    table = rig_table()
    assert built({}) == (single_muscle_joint(),)
    (joint,) = built(checked(table, {}))
    assert (joint.muscle, joint.load) == (single_muscle_joint().muscle, Mass())
    assert not joint.all_present


def test_a_joint_has_the_effects_that_are_given_and_no_others():
    assert built({'mass': 7.0, RUBS: 12.0}) == (single_muscle_joint(load=Mass(7.0), effects=RUB),)


def test_what_nobody_gives_a_name_has_its_default_and_equal_joints_are_one():
    values = {'a.mass': 2.0, 'b.zeta': 0.2, 'c.mass': 2.0, 'zeta': 0.1}
    a, b, c = built(values, muscles=['a', 'b', 'c'])
    assert [joint.load.mass for joint in (a, b)] == [2.0, Mass().mass]
    assert [joint.muscle.zeta for joint in (a, b)] == [0.1, 0.2]
    assert a is c


def test_which_of_two_muscles_a_value_is_of_makes_another_joint():
    names = {'joint': 'antagonistic', 'muscles': ['a', 'b', 'c', 'd']}
    one, other = built({'a.zeta': 0.2, 'd.zeta': 0.2}, **names)
    assert [m.zeta for m in one.muscles] == [m.zeta for m in reversed(other.muscles)]
    assert one.muscles[0].zeta == 0.2 != one.muscles[1].zeta


def test_common_values_make_a_joint_that_has_nobodys_own():
    values = {'mass': 3.0, 'a.mass': 4.0}
    joint = RigParameters({'muscles': ['a']}).build_common(values)
    assert joint == single_muscle_joint(load=Mass(3.0))


# Joints of a file ------------------------------------------------------------------------------


@pytest.mark.parametrize('name', MUSCLES)
def test_every_muscle_of_the_package_makes_a_rig(name):
    assert MUSCLES
    nominal = nominal_joint(name, ['mass=5'])
    values = nominal.flat()
    assert nominal.joint.load.mass == values['mass'] == 5.0
    assert values['source']


def test_the_built_in_muscle_is_the_papers():
    model = nominal_joint('dmsp_20_400n').joint
    assert (model.parameters() == single_muscle_joint().parameters()).all()


def test_a_mistyped_name_in_a_file_is_refused_and_a_strangers_is_not(file):
    path = file('mass: 7, robot_name: arm')
    model = nominal_joint(path).joint
    assert model.load.mass == 7.0
    path = file('mas: 7')
    with pytest.raises(ParameterError, match=r'given.yaml: mas .* was mass meant'):
        nominal_joint(path)


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        ('effects.magic.gain: 1', r'effects\.magic is not known: give one of dead_time, '),
        ('effects.payload.weight: 1', r'effects\.payload\.weight is not known: give one of mass'),
        ('effects.payload.mass: -1e9', r'effects\.payload\.mass = -1000000000\.0 is not allowed'),
        ('effects.creep.time: a', r"effects\.creep\.time = 'a' is not allowed"),
        ('mass: a', r"mass = 'a' is not allowed"),
        ('l0: [a]', r"l0 = \('a',\) is not allowed"),
        ('mass: 9000', 'mass = 9000 kg and this muscle do not fit together: '),
    ],
)
def test_a_file_that_makes_no_rig_is_refused(file, given, sentence):
    with pytest.raises(ParameterError, match=sentence):
        nominal_joint(file(given))


def flat_of(joint):
    return NominalJoint(joint, LOAD, ('muscle',), 'muscle').flat()


def test_the_rig_of_a_file_is_simulated(file):
    """Of a file of all values as well, whose effects of no strength are not present."""
    path = file(f'mass: 7, {RUBS}: 12')
    scene = Scene({'muscle': path})
    (simulated,) = scene.build(checked(scene.table(), {})).joints
    whole = ', '.join(f'{name}: {value!r}' for name, value in flat_of(simulated).items())
    assert whole.count('effects.') == sum(len(effect.parameters()) for effect in EFFECTS)
    for name in (path, file(whole)):
        model = nominal_joint(name).joint
        assert model.parameters().tobytes() == simulated.parameters().tobytes()
        assert [effect.name for effect in model.all_present] == ['coulomb_friction']
