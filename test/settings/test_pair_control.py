# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the controller of a pair is told, put together and checked as a whole."""

from pathlib import Path

import pytest
from pam_ros.control.pair_law import PairLaw
from pam_ros.rig.joints.antagonistic_pair import PulleyArm
from pam_ros.settings.pair_control import ToldPair, settings_of

from pam_ros.control.co_contraction import CoContraction
from pam_ros.control.shaping import Turn
from pam_ros.errors import ParameterError, RangeError
from pam_ros.settings.files import read
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked, table_of

CONFIG = Path(__file__).parents[2] / 'config'
MUSCLES = sorted(path.stem for path in (CONFIG / 'muscles').glob('*.yaml'))
FOUR = {'muscles': ('a', 'b', 'c', 'd'), 'joint_names': ('shoulder', 'elbow')}


def told(**given):
    given = {'joint': 'antagonistic'} | {
        name.replace('__', '.'): value for name, value in given.items()
    }
    table, build = settings_of(given)
    return build(checked(table, given))


def test_the_file_lists_joint_and_settings_with_their_defaults():
    table, _ = settings_of({'joint': 'antagonistic'})
    names = {*table_of(PulleyArm), *table_of(CoContraction), *table_of(Turn, 'shape.')}
    expected = {name: table[name][1] for name in names} | {'joint': 'antagonistic'}
    assert read(CONFIG / 'antagonistic.yaml', 'pam_control') == expected
    simulated = Scene({'joint': 'antagonistic'}).table()
    values = read(CONFIG / 'antagonistic.yaml', 'pam_sim')
    assert values.pop('joint') == 'antagonistic'
    assert values == {name: simulated[name][1] for name in table_of(PulleyArm)}


@pytest.mark.parametrize('muscle', MUSCLES)
def test_a_pair_of_every_muscle_can_be_controlled(muscle):
    now = told(muscle=muscle, gains__disturbance_bound=2.0)
    low, high = now.reach
    assert low < 0.0 < high
    assert isinstance(now.make_law(), PairLaw)


def test_one_muscle_is_what_it_was():
    table, build = settings_of({})
    assert 'co_contraction' not in table
    assert 'radius' not in table
    assert not isinstance(build(checked(table, {})), ToldPair)


def test_both_programs_make_the_same_joint_of_the_same_values():
    given = {
        'joint': 'antagonistic',
        'muscles': ('flexor', 'extensor'),
        'radius': 0.05,
        'extensor.muscle': 'dmsp_20_200n',
        'flexor.effects.pressure_lag.fill': 0.03,
        'effects.viscous_friction.coefficient': 0.2,
        'extensor.initial.pressure': 1e5,
    }
    scene = Scene(given)
    (simulated,) = scene.build(checked(scene.table(), given)).models
    table, build = settings_of(given)
    assert build(checked(table, given)).model == simulated


def test_of_several_joints_one_is_controlled():
    now = told(**FOUR, joint_name='elbow', muscle_topics=True, d__l0=0.5)
    assert now.muscles == ('c', 'd')
    assert now.settings.joint_name == 'elbow'
    assert [m.l0 for m in now.model.muscles] == [0.4, 0.5]


@pytest.mark.parametrize(
    ('change', 'needs'),
    [
        ({'gains__bandwidth': 20.0}, False),
        ({'co_contraction': 30.0}, False),
        ({'shape__max_velocity': 1.0}, False),
        ({'mass': 1.5}, True),
        ({'limits__pressure_high': 5e5}, True),
    ],
)
def test_only_another_joint_or_other_limits_need_a_new_law(change, needs):
    assert told(**change).needs_new_law(told()) == needs


def test_gains_and_stiffness_are_taken_over():
    before, now = told(), told(gains__bandwidth=20.0, co_contraction=33.0)
    law = before.make_law()
    now.take_over(law, before)
    assert law.gains.bandwidth == 20.0
    for _ in range(400):
        law._stiffness.follow(2e-3)
    assert law._stiffness.stiffness == 33.0


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        ({'controller': 'pid'}, 'controller = pid is for one muscle'),
        ({**FOUR}, 'joint_name = pam is none of the joints shoulder, elbow'),
        ({**FOUR, 'joint_name': 'elbow'}, 'set muscle_topics, here and in pam_sim'),
        ({'gains__velocity_bandwidth': 1000.0}, 'too fast for a control rate of 500 Hz'),
        ({'limits__pressure_low': 700e3}, 'leaves no range below the p_max'),
    ],
)
def test_what_does_not_go_together_is_refused(given, sentence):
    with pytest.raises(ParameterError, match=sentence):
        told(**given)


def test_a_stiffness_that_cannot_be_had_is_refused_with_the_range():
    with pytest.raises(RangeError, match=r'co-contraction 90 N m/rad .* 11.68 to 46.12 N m/rad'):
        told(co_contraction=90.0)
