# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The settings of the controller of a joint, put together and checked as a whole."""

from pathlib import Path

import pytest

from pam_ros.control.co_contraction import CoContraction
from pam_ros.control.pid import Pid, PidGains
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.errors import ParameterError, RangeError
from pam_ros.rig.arrangements import ANTAGONISTIC
from pam_ros.rig.loads import Arm
from pam_ros.rig.transmissions import Pulley
from pam_ros.settings.control import settings_of
from pam_ros.settings.files import read
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked, joint_table, table_of

CONFIG = Path(__file__).parents[2] / 'config'
MUSCLES = sorted(path.stem for path in (CONFIG / 'muscles').glob('*.yaml'))
FOUR = {'muscles': ('a', 'b', 'c', 'd'), 'joint_names': ('shoulder', 'elbow')}


def setup_of(**given):
    given = {'joint': 'antagonistic'} | {
        name.replace('__', '.'): value for name, value in given.items()
    }
    table, build = settings_of(given)
    return build(checked(table, given))


def test_the_file_lists_joint_and_settings_with_their_defaults():
    table, _ = settings_of({'joint': 'antagonistic'})
    of_joint = {name for name in joint_table(ANTAGONISTIC) if not name.startswith('effects.')}
    parts = {'contraction_1', 'contraction_2', *table_of(Pulley), *table_of(Arm)}
    assert of_joint == parts
    names = {*of_joint, *table_of(CoContraction), *table_of(Shape, 'shape.')}
    expected = {name: table[name][1] for name in names} | {'joint': 'antagonistic'}
    assert read(CONFIG / 'antagonistic.yaml', 'pam_control') == expected
    simulated = Scene({'joint': 'antagonistic'}).table()
    values = read(CONFIG / 'antagonistic.yaml', 'pam_sim')
    assert values.pop('joint') == 'antagonistic'
    assert values == {name: simulated[name][1] for name in of_joint}


@pytest.mark.parametrize('muscle', MUSCLES)
def test_a_pair_of_every_muscle_can_be_controlled(muscle):
    now = setup_of(muscle=muscle, gains__disturbance_bound=2.0)
    low, high = now.law.reach
    assert low < 0.0 < high
    assert isinstance(now.law.make_law(), SlidingMode)
    assert now.law.can_stiffen


def test_a_joint_of_one_muscle_is_unchanged():
    table, build = settings_of({})
    assert 'co_contraction' not in table
    assert 'radius' not in table
    now = build(checked(table, {}))
    assert not now.law.can_stiffen
    assert (now.law.unit, len(now.topics.muscles), now.topics.is_array) == ('m', 1, False)


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
    (simulated,) = scene.build(checked(scene.table(), given)).joints
    table, build = settings_of(given)
    assert build(checked(table, given)).law.joint == simulated


def test_of_several_joints_one_is_controlled():
    now = setup_of(**FOUR, joint_name='elbow', muscle_topics=True, d__l0=0.5)
    assert now.topics.muscles == ('c', 'd')
    assert now.settings.joint_name == 'elbow'
    assert [m.l0 for m in now.law.joint.muscles] == [0.4, 0.5]


@pytest.mark.parametrize(
    ('change', 'needs'),
    [
        ({'gains__bandwidth': 20.0}, False),
        ({'co_contraction': 30.0}, False),
        ({'shape__max_velocity': 1.0}, False),
        ({'mass': 1.5}, True),
        ({'limits__pressure_high': 5e5}, True),
        ({'pid__integral': 1e6}, True),
    ],
)
def test_only_another_joint_or_other_limits_need_a_new_law(change, needs):
    assert setup_of(**change).law.needs_new_law(setup_of().law) == needs


def test_gains_and_stiffness_are_taken_over():
    before, now = setup_of(), setup_of(gains__bandwidth=20.0, co_contraction=33.0)
    law = before.law.make_law()
    now.law.take_over(law, before.law)
    assert law.gains.bandwidth == 20.0
    for _ in range(400):
        law._stiffness.follow(2e-3)
    assert law._stiffness.stiffness == 33.0


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        ({**FOUR}, 'joint_name = pam is not one of the joints shoulder, elbow'),
        ({**FOUR, 'joint_name': 'elbow'}, 'set muscle_topics, here and in pam_sim'),
        ({'gains__velocity_bandwidth': 1000.0}, 'too fast for a control rate of 500 Hz'),
        ({'limits__pressure_low': 700e3}, 'leaves no range below the p_max'),
    ],
)
def test_what_does_not_go_together_is_refused(given, sentence):
    with pytest.raises(ParameterError, match=sentence):
        setup_of(**given)


def test_a_stiffness_that_cannot_be_had_is_refused_with_the_range():
    with pytest.raises(RangeError, match=r'co-contraction 90 N m/rad .* 11.68 to 46.12 N m/rad'):
        setup_of(co_contraction=90.0)


# PID, and joints of other kinds ------------------------------------------------------------------


def test_the_baseline_is_for_a_pair_too():
    now = setup_of(controller='pid', co_contraction=30.0)
    law = now.law.make_law()
    assert isinstance(law, Pid)
    assert law.gains == PidGains.revolute()
    law.start(0.1)
    assert law.model.stiffness(law.terms.pressures, 0.1) == pytest.approx(30.0)
    # It takes another stiffness as a new law, as it takes the place of another one.
    assert now.law.needs_new_law(setup_of(co_contraction=30.0).law)
    assert setup_of(controller='pid', co_contraction=33.0).law.needs_new_law(now.law)
    with pytest.raises(RangeError, match='co-contraction 90 N m/rad'):
        setup_of(controller='pid', co_contraction=90.0)


@pytest.mark.parametrize(
    ('kind', 'muscles', 'unit', 'can_stiffen', 'has_arrays'),
    [
        ('load', 1, 'm', False, False),
        ('parallel', 2, 'm', False, True),
        ('antagonistic', 2, 'rad', True, True),
        ('lever', 2, 'rad', True, True),
        ('crank', 1, 'rad', False, True),
    ],
)
def test_each_kind_of_joint_can_be_controlled(kind, muscles, unit, can_stiffen, has_arrays):
    now = setup_of(joint=kind)
    assert (len(now.topics.muscles), now.law.unit) == (muscles, unit)
    assert (now.law.can_stiffen, now.topics.is_array) == (can_stiffen, has_arrays)
    assert now.law.reach[0] < now.law.reach[1]
    assert isinstance(now.law.make_law(), SlidingMode)
    table, _ = settings_of({'joint': kind})
    assert ('co_contraction' in table) is can_stiffen
    topics = setup_of(joint=kind, muscle_topics=True).topics.commands
    assert topics == tuple(f'{name}/pressure_command' for name in now.topics.muscles)


def test_of_several_loads_one_is_controlled_by_its_own_topic():
    names = {'joint': 'load', 'muscles': ('left', 'right'), 'muscle_topics': True}
    now = setup_of(**names, joint_name='right', right__mass=12.0)
    assert (now.topics.muscles, now.settings.joint_name) == (('right',), 'right')
    assert now.law.joint.load.mass == 12.0
    assert now.topics.commands == ('right/pressure_command',)
    assert now.topics.pressures == ('right/pressure',)
    with pytest.raises(
        ParameterError, match='joint_name = pam is not one of the joints left, right'
    ):
        setup_of(**names)


# Units, ranges and defaults of a joint that turns ------------------------------------------------

REVOLUTE = {
    'gains.bandwidth': ('1/s', 25.0, 200.0),
    'gains.fast_bandwidth': ('1/s', 50.0, 200.0),
    'gains.surface_bandwidth': ('rad/s', 8.0, 200.0),
    'gains.surface_damping': ('', 0.5, 5.0),
    'gains.disturbance_bound': ('N m', 5.0, 1e5),
    'gains.observer_bandwidth': ('rad/s', 8.0, 200.0),
    'gains.rest_factor': ('', 0.3, 1.0),
    'gains.rest_tolerance': ('rad', 2e-4, 1.0),
    'gains.pressure_time': ('s', 0.02, 1.0),
    'shape.max_velocity': ('rad/s', 2.0, 100.0),
    'shape.max_acceleration': ('rad/s^2', 15.0, 1e4),
    'shape.max_jerk': ('rad/s^3', 300.0, 1e7),
    'pid.proportional': ('Pa/rad', 49.1e3, 1e9),
    'pid.integral': ('Pa/(rad s)', 1.91e6, 1e10),
    'pid.derivative': ('Pa s/rad', 9.09e3, 1e9),
    'pid.filter_bandwidth': ('rad/s', 326.0, 1e4),
    'co_contraction': ('N m/rad', 0.0, 1e6),
    'co_contraction_rate': ('N m/(rad s)', 100.0, 1e6),
}
STRAIGHT = {
    'gains.bandwidth': ('1/s', 14.0, 200.0),
    'gains.disturbance_bound': ('N', 200.0, 1e5),
    'gains.rest_tolerance': ('m', 12e-6, 0.01),
    'shape.max_velocity': ('m/s', 0.1, 10.0),
    'shape.max_jerk': ('m/s^3', 6.0, 1e6),
    'pid.proportional': ('Pa/m', 0.82e6, 1e9),
    'pid.integral': ('Pa/(m s)', 39e6, 1e10),
    'pid.derivative': ('Pa s/m', 194e3, 1e9),
    'pid.filter_bandwidth': ('rad/s', 282.0, 1e4),
}


@pytest.mark.parametrize(
    ('kind', 'expected'),
    [
        ('antagonistic', REVOLUTE),
        ('lever', REVOLUTE),
        ('crank', {k: v for k, v in REVOLUTE.items() if not k.startswith('co_')}),
        ('parallel', STRAIGHT),
        ('load', STRAIGHT),
    ],
)
def test_settings_have_the_units_ranges_and_defaults_of_their_joint(kind, expected):
    table, _ = settings_of({'joint': kind})
    for name, (unit, default, high) in expected.items():
        _, now, about = table[name]
        assert (about.unit, now, about.high) == (unit, default, high), name
