# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the parameters of a rig say about a pressure or a position that a person gives."""

import pytest

from pam_ros.command.amounts import amount_of
from pam_ros.command.rig import checked_position, checked_pressure, ordered, rig_of, unit_of
from pam_ros.errors import PamError
from pam_ros.settings.control import settings_of
from pam_ros.settings.scene import Scene


def values_of(**given):
    """Return all parameters of a pam_sim that is started with *given*."""
    scene = Scene(given)
    return {name: entry[1] for name, entry in scene.table().items()} | given


def rig(**given):
    return rig_of('/pam_sim', values_of(**given))


def pressure(text):
    return amount_of(text, ('Pa',), 'pressure')


def pressures(*texts):
    found = [text.rpartition(':=') for text in texts]
    return [(name, pressure(value)) for name, _, value in found]


def test_limits_are_those_of_each_muscle():
    found = rig(muscles=('left', 'right'), **{'right.p_max': 400e3})
    assert found.muscles == ('left', 'right')
    assert found.limits == ((0.0, 600e3), (0.0, 400e3))
    assert checked_pressure('left', pressure('5bar'), found) == 500e3
    with pytest.raises(PamError, match=r'5bar \(500000 Pa\).*/pam_sim \(right\).* to 400000 Pa'):
        checked_pressure('right', pressure('5bar'), found)


def test_muscles_of_a_pair_have_the_names_of_pam_sim():
    assert rig(joint='antagonistic', joint_name='elbow').muscles == ('elbow_1', 'elbow_2')


def test_a_controller_and_a_node_of_another_kind_are_no_rig():
    assert rig_of('/talker', {'use_sim_time': False}) is None
    assert unit_of({'use_sim_time': False}) == ''


@pytest.mark.parametrize(
    ('given', 'repeat'),
    [
        ({'command_timeout': 1.0}, 0.1),
        ({'command_timeout': 0.1}, 0.02),
        ({'command_timeout': 1.0, 'time_mode': 'scaled', 'speed_factor': 20.0}, 0.01),
        ({'command_timeout': 1.0, 'time_mode': 'scaled', 'speed_factor': 0.0}, 0.001),
        ({'command_timeout': 0.0}, None),
        ({'command_timeout': 0.0, 'time_mode': 'lockstep', 'publish_rate': 200.0}, 0.005),
    ],
)
def test_commands_are_repeated_before_the_rig_vents(given, repeat):
    assert rig(**given).repeat == (None if repeat is None else pytest.approx(repeat))


@pytest.mark.parametrize('text', ['450', '3', '-450', '29.5'])
def test_a_small_number_without_a_unit_is_taken_for_one_in_another_unit(text):
    found = rig(p_min=-500.0)
    for known in (found, None):
        with pytest.raises(PamError, match=f'{text}kPa, {text}bar or {text}Pa'):
            checked_pressure(found.muscles[0], pressure(text), known)
    assert checked_pressure('pam', pressure(f'{text}Pa'), found) == float(text)


def test_a_rig_of_low_pressures_permits_small_numbers():
    assert checked_pressure('pam', pressure('450'), rig(p_max=8e3)) == 450.0
    assert checked_pressure('pam', pressure('0'), rig()) == 0.0


@pytest.mark.parametrize('text', ['450e6', '101kbar', '-2bar'])
def test_pressures_that_no_rig_has_are_refused_without_a_rig(text):
    with pytest.raises(PamError):
        checked_pressure('', pressure(text), None)


def test_pressures_have_the_order_of_the_muscles():
    found = rig(muscles=('left', 'right'))
    assert ordered(pressures('right:=2bar', 'left:=1bar'), found) == [1e5, 2e5]
    assert ordered(pressures('1bar', '2bar'), found) == [1e5, 2e5]
    assert ordered(pressures('1bar', '2bar', '3bar'), None) == [1e5, 2e5, 3e5]


@pytest.mark.parametrize(
    ('texts', 'words'),
    [
        (['1bar'], ['1 pressure for 2 muscles', 'left, right']),
        (['1bar', '2bar', '3bar'], ['3 pressures for 2 muscles']),
        (['left:=1bar'], ['left, right', 'muscle_topics']),
        (['left:=1bar', 'middle:=1bar'], ['left, middle', 'left, right']),
    ],
)
def test_other_muscles_than_those_of_the_rig_are_refused(texts, words):
    with pytest.raises(PamError) as error:
        ordered(pressures(*texts), rig(muscles=('left', 'right')))
    for word in words:
        assert word in str(error.value)


def test_names_need_a_rig_that_knows_them():
    with pytest.raises(PamError, match='without names'):
        ordered(pressures('left:=1bar'), None)


def position(text):
    return amount_of(text, ('m', 'rad'), 'position')


def test_the_unit_of_a_position_is_that_of_the_joint():
    units = {}
    for joint in ('load', 'parallel', 'antagonistic', 'lever', 'crank'):
        table, _ = settings_of({'joint': joint})
        values = {name: entry[1] for name, entry in table.items()} | {'joint': joint}
        units[joint] = unit_of(values)
    turning = dict.fromkeys(('antagonistic', 'lever', 'crank'), 'rad')
    assert units == {'load': 'm', 'parallel': 'm', **turning}
    assert checked_position(position('60mm'), 'm', '/pam_control') == pytest.approx(0.06)
    assert checked_position(position('0.06'), 'rad', '/pam_control') == 0.06
    with pytest.raises(PamError, match='60mm is in m, but the position of /c is an angle'):
        checked_position(position('60mm'), 'rad', '/c')
    with pytest.raises(PamError, match='20deg is in rad, but the position of /c is a length'):
        checked_position(position('20deg'), 'm', '/c')


def test_a_position_is_left_to_a_controller_that_knows_its_reach():
    assert checked_position(position('60'), 'm', '/c') == 60.0
    for text in ('60', '60m', '400deg'):
        with pytest.raises(PamError, match='not a plausible position'):
            checked_position(position(text), '', '/c')
