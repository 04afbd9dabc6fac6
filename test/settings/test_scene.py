# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Several muscles and joints put together from flat parameters, as a whole."""

import pytest

from pam_ros.errors import ParameterError
from pam_ros.rig.joint import Joint
from pam_ros.rig.transmissions import Lever, Pulley
from pam_ros.settings.files import write
from pam_ros.settings.nominal import nominal_joint
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from support.by_name import by_name


def of(given):
    scene = Scene(given)
    return scene.build(checked(scene.table(), given))


def built(**given):
    given = {name.replace('__', '.'): value for name, value in given.items()}
    return of(given)


def test_a_scene_of_one_muscle_is_unchanged():
    now = built(mass=12.0, joint_name='arm')
    assert (now.joint_names, now.muscle_names) == (('arm',), ('arm',))
    assert not now.has_arrays
    assert now.command_topics == ('pressure_command',)
    assert now.muscle_joints == ('arm',)
    assert now.joints[0].load.mass == 12.0


def test_names_have_their_own_and_follow_in_the_rest():
    now = built(
        muscles=['a', 'b'], mass=12.0, b__mass=7.0, a__effects__coulomb_friction__level=5.0
    )
    a, b = now.joints
    assert (a.load.mass, b.load.mass) == (12.0, 7.0)
    assert [by_name(joint.effects)['coulomb_friction'].level for joint in (a, b)] == [5.0, 0.0]
    assert now.joint_names == now.muscle_names == ('a', 'b')


STOPS = {'effects.end_stop.stiffness': 1e4, 'effects.end_stop.lower_stiffness': 1e4}


@pytest.mark.parametrize(
    ('given', 'words'),
    [
        ({'effects.nosuch.level': 3.0}, r'effects\.nosuch is not known: give one of dead_time'),
        ({'effects.creep.nosuch': 3.0}, r'effects\.creep\.nosuch is not known: give one of '),
        ({'effects.creep': 3.0}, r'effects\.creep is not a parameter: give effects\.<effect>\.<p'),
        (
            {'effects.payload.mass': -20.0},
            r'mass = -20 kg leaves 0 kg of mass = 20 kg: give at le',
        ),
        ({'effects.payload.mass': -16.1}, r'leaves 3\.9 kg of mass = 20 kg: give at least -16 kg'),
        ({'mass': 3.0, 'effects.payload.mass': -9.0}, r'leaves -6 kg of mass = 3 kg'),
        (
            STOPS | {'effects.end_stop.upper': 0.1, 'effects.end_stop.lower': 0.2},
            r'end_stop\.lower = 0\.2 is not allowed: give less than .*upper = 0\.1',
        ),
        (
            STOPS | {'effects.end_stop.lower': 0.25},
            r'end_stop\.lower = 0\.25 is not allowed',
        ),
    ],
)
def test_what_makes_no_rig_is_refused(tmp_path, given, words):
    """Given as parameters, and by a file in their place."""
    with pytest.raises(ParameterError, match=words):
        of({'mass': 20.0} | given)
    path = tmp_path / 'rig.yaml'
    write(path, {'mass': 20.0} | given)
    with pytest.raises(ParameterError, match=words):
        of({'muscle': str(path)})
    with pytest.raises(ParameterError, match=words):
        nominal_joint(path)


def test_effects_have_no_start_of_their_own():
    with pytest.raises(
        ParameterError, match=r'initial\.creep\.strain is not a parameter: give one'
    ):
        of({'initial.creep.strain': 0.1})


@pytest.mark.parametrize(
    'given',
    [
        {'effects.payload.mass': -16.0},
        {'effects.end_stop.lower': 0.3, 'effects.end_stop.lower_stiffness': 1e4},
    ],
)
def test_what_makes_one_is_taken(given):
    assert of({'mass': 20.0} | given)


def test_only_what_a_name_is_given_is_configured_for_it():
    table = Scene({'muscles': ['a', 'b'], 'b.mass': 7.0}).table()
    assert [name for name in table if name.startswith(('a.', 'b.'))] == ['b.mass']


def test_a_preset_of_a_name_goes_before_everybodys_and_after_its_own():
    now = built(muscles=['a', 'b'], l0=0.6, b__muscle='dmsp_10', b__zeta=0.33)
    a, b = (joint.muscle for joint in now.joints)
    assert (a.l0, b.l0, b.zeta) == (0.6, 0.25, 0.33)


def test_of_a_preset_a_pair_takes_the_muscle_and_not_its_load():
    plain, preset = built(joint='antagonistic'), built(joint='antagonistic', muscle='dmsp_10')
    assert preset.joints[0].load == plain.joints[0].load
    assert [m.l0 for m in preset.muscles] == [0.25, 0.25]


def test_equal_muscles_are_one_joint():
    now = built(muscles=[f'm{i}' for i in range(64)], m3__mass=9.0)
    assert len({id(joint) for joint in now.joints}) == 2


def test_effects_of_a_pair_are_where_they_act():
    now = built(
        joint='antagonistic',
        effects__coulomb_friction__level=0.5,
        pam_1__effects__pressure_lag__fill=0.02,
        pam__hanging_at=0.2,
    )
    (pair,) = now.joints
    assert isinstance(pair, Joint)
    assert pair.transmission == Pulley()
    assert by_name(pair.effects)['coulomb_friction'].level == 0.5
    assert [by_name(a.effects)['pressure_lag'].fill for a in pair.actuators] == [0.02, 0.0]
    assert pair.load.hanging_at == 0.2


@pytest.mark.parametrize(('kind', 'muscles'), [('lever', 2), ('crank', 1)])
def test_a_lever_is_configured_by_its_geometry(kind, muscles):
    now = built(
        joint=kind,
        joint_name='elbow',
        crank=0.05,
        angle=1.6,
        contraction_1=0.08,
        effects__end_stop__upper=0.9,
        elbow__effects__payload__mass=0.2,
    )
    (joint,) = now.joints
    assert joint.transmission == Lever(crank=0.05, angle=1.6)
    assert [a.contraction for a in joint.actuators] == [0.08, 0.1][:muscles]
    assert by_name(joint.effects)['end_stop'].upper == 0.9
    assert joint.moved_mass == joint.load.mass + 0.2
    assert now.joint_names == ('elbow',)
    assert len(now.muscle_names) == muscles
    assert now.has_arrays
    assert now.command_topics == ('pressure_commands',)
    assert now.muscle_prefixes == now.muscle_joints == ()


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        ({'muscles': ['a', 'a']}, 'a is named twice'),
        ({'muscles': ['effects']}, 'effects is the name of a parameter'),
        ({'muscles': ['1st']}, "'1st' is not a valid name"),
        ({'muscles': ['a__b']}, "'a__b' is not a valid name"),
        ({'muscles': ['a', 'b', 'c'], 'joint': 'parallel'}, '3 names do not fit joint = parallel'),
        ({'muscles': ['a', 'b'], 'joint_names': ['x']}, '1 names for 2 joints'),
        ({'muscles': ['a'], 'a.sensor.latency': 0.1}, 'a has no parameter of this name'),
        ({'muscles': ['a'], 'a.zeta_': 0.1}, 'was a.zeta meant'),
        ({'muscles': ['a', 'b'], 'b.initial.pressure': 9e5}, 'b: initial.pressure = 900000'),
        (
            {'muscles': ['a', 'b'], 'b.initial.at_rest': False, 'b.initial.position': 0.5},
            'b: initial.position = 0.5 m is not possible',
        ),
        (
            {'joint': 'antagonistic', 'initial.at_rest': False, 'initial.position': 5.0},
            'initial.position = 5 rad is not possible with joint = antagonistic: give -3 to 3 rad',
        ),
        ({'joint': 'lever', 'angle': 4.0}, 'angle = 4.0 is not allowed: give 0.1 to 3 rad'),
        ({'muscles': 'a'}, 'muscles = .a. is not allowed: give a list of texts'),
        ({'time_mode': 'lockstep', 'clock_rate': 2000.0}, 'clock_rate = 2000 Hz is above'),
    ],
)
def test_what_does_not_go_together_is_refused(given, sentence):
    with pytest.raises(ParameterError, match=sentence):
        of(given)
