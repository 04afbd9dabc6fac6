# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The rigs that ``pam_excite`` excites: each kind of joint, its topics, its window, its plan."""

from pathlib import Path

import numpy as np
import pytest

from pam_ros.errors import ParameterError
from pam_ros.rig.arrangements import ARRANGEMENTS
from pam_ros.settings.excite import settings_of
from pam_ros.settings.files import find, read, write
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked

ANTAGONISTIC = Path(__file__).parents[2] / 'config' / 'antagonistic.yaml'
ARRAY, ONE = ('pressure_commands',), ('pressure_command',)


def experiment(given):
    table, build = settings_of(given)
    return build(checked(table, given))


@pytest.mark.parametrize('kind', ARRANGEMENTS, ids=lambda kind: kind.name)
def test_each_kind_of_joint_is_excited_on_the_topics_that_pam_sim_has_of_it(kind):
    given = {'joint': kind.name, 'muscle': 'dmsp_10'}
    made = experiment(given)
    scene = Scene(given)
    simulated = scene.build(checked(scene.table(), given))
    assert made.model == simulated.joints[0]
    assert made.topics.commands == simulated.command_topics
    assert made.topics.muscles == simulated.muscle_names
    assert made.programme.pressure.shape[1] == kind.muscles
    assert made.model.muscles[0].l0 == 0.25


def test_the_same_file_is_used_as_for_the_simulator():
    made = experiment(read(ANTAGONISTIC))
    assert (made.topics.commands, made.unit) == (ARRAY, 'rad')
    elbow = experiment(read(find('laas_elbow')))
    assert elbow.topics.muscles == ('agonist', 'antagonist')
    assert elbow.model.muscles[0].l0 == 0.185


def test_muscles_on_opposite_sides_are_moved_against_each_other_and_others_together():
    def triangle(**given):
        made = experiment({'segments': ('slow_triangle',), **given}).programme
        part = made.segments[1]
        return made.pressure[part.start + 300 : part.stop].T

    first, second = triangle(joint='antagonistic')
    np.testing.assert_allclose(first + second, 500e3)
    one, other = triangle(joint='parallel')
    np.testing.assert_array_equal(one, other)


def test_the_window_of_a_pulley_is_that_of_its_muscles():
    """By hand: 0.4 m (0.25 - 0.1) / 0.04 m, and 0.4 m (0.1 + 0.04) / 0.04 m is less."""
    assert experiment({'joint': 'antagonistic'}).window == pytest.approx((-1.4, 1.4))
    given = {'joint': 'antagonistic', 'contraction_1': 0.2, 'contraction_min': -0.02}
    # Of the first muscle 0.05 up and 0.22 down, of the second one 0.12 up and 0.15 down.
    assert experiment(given).window == pytest.approx((-1.5, 0.5))


def test_stops_of_the_rig_narrow_the_window():
    given = {'joint': 'antagonistic', 'position_min': -0.3, 'position_max': 0.5}
    made = experiment(given)
    assert made.window == (-0.3, 0.5)
    assert 'stops and vents outside -0.300 to 0.500 rad, and after' in made.plan()
    assert 'CAUTION: that leaves the window' in made.plan()
    assert experiment({'position_max': 0.02}).window == pytest.approx((-0.016, 0.02))


def test_a_window_without_a_position_is_refused():
    given = {'joint': 'antagonistic', 'position_min': 1.5}
    with pytest.raises(ParameterError, match=r'no position is within .* 1\.5 to 10 rad$'):
        experiment(given)


def test_the_limits_of_each_muscle_apply():
    given = {
        'joint': 'antagonistic',
        'muscles': ('flexor', 'extensor'),
        'extensor.p_max': 3e5,
        'flexor.kappa_max': 0.2,
    }
    made = experiment(given)
    assert made.programme.pressure.max() == pytest.approx(3e5)
    assert made.window == pytest.approx((-1.0, 1.0))


def test_of_several_joints_one_is_excited():
    four = {
        'joint': 'antagonistic',
        'muscles': ('a', 'b', 'c', 'd'),
        'joint_names': ('shoulder', 'elbow'),
    }
    made = experiment({**four, 'joint_name': 'elbow', 'muscle_topics': True, 'd.l0': 0.5})
    assert made.topics.commands == ('c/pressure_command', 'd/pressure_command')
    assert [m.l0 for m in made.model.muscles] == [0.4, 0.5]
    with pytest.raises(ParameterError, match='set muscle_topics, here and in pam_sim'):
        experiment({**four, 'joint_name': 'elbow'})
    with pytest.raises(ParameterError, match='the rig has 2 joints, shoulder, elbow: choose'):
        experiment({**four, 'muscle_topics': True})


def test_one_muscle_with_a_load_of_its_own_has_any_name():
    for given in ({}, {'joint_name': 'knee'}, {'muscles': ('knee', 'hip'), 'joint_name': 'other'}):
        made = experiment({**given, 'mass': 7.0})
        assert made.topics.commands == ONE
        assert made.model.load.mass == 7.0
    made = experiment({'muscles': ('knee', 'hip'), 'joint_name': 'hip', 'hip.mass': 3.0})
    assert made.model.load.mass == 3.0


def test_nothing_can_be_changed_while_it_plays():
    given = {'joint': 'lever', 'muscles': ('flexor', 'extensor'), 'flexor.l0': 0.3}
    assert not any(about.live for _, _, about in settings_of(given)[0].values())


def test_a_joint_that_does_not_exist_is_refused():
    with pytest.raises(ParameterError, match=r"joint = 'shoulder' .* one of load, parallel, "):
        experiment({'joint': 'shoulder'})


@pytest.mark.parametrize('values', [{'joint': 'lever', 'crank': 0.05}, {'joint': 'parallel'}])
def test_the_file_of_a_joint_is_not_one_of_a_muscle(tmp_path, values):
    file = tmp_path / 'arm.yaml'
    write(file, values)
    sentence = rf'arm\.yaml describes a joint \({values["joint"]}\), not a muscle'
    with pytest.raises(ParameterError, match=sentence):
        settings_of({'muscle': str(file)})
    with pytest.raises(ParameterError, match=sentence):
        Scene({'muscle': str(file)})


def test_positions_are_in_the_unit_of_the_joint():
    for kind, unit in (('load', 'm'), ('antagonistic', 'rad'), ('parallel', 'm')):
        table, _ = settings_of({'joint': kind})
        assert table['position_max'][2].unit == unit
        assert table['contraction_max'][2].unit == 'fraction of l0'
