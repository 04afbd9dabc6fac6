# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The settings of the controller, put together and checked as a whole."""

from pathlib import Path

import pytest

from pam_ros.control.pid import Pid
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.errors import ParameterError
from pam_ros.settings.braid import BRAID
from pam_ros.settings.control import settings_of
from pam_ros.settings.files import read
from pam_ros.settings.tables import checked, rig_table

CONFIG = Path(__file__).parents[2] / 'config'
MUSCLES = sorted(path.stem for path in (CONFIG / 'muscles').glob('*.yaml'))


def table(given):
    return settings_of(given)[0]


def setup_of(given, muscle=''):
    names, build = settings_of({'muscle': muscle})
    return build(checked(names, given))


def test_control_yaml_lists_all_but_the_rig_and_the_gains_with_its_defaults():
    values = read(CONFIG / 'control.yaml', 'pam_control')
    # ROS has no empty list in a file: names are shown in a comment there.
    left_out = {*rig_table(), *BRAID, 'muscle', 'muscles', 'joint_names'}
    beside = {
        name: default
        for name, (_, default, _) in table({}).items()
        if name not in left_out and not name.startswith(('gains.', 'pid.'))
    }
    assert values == beside


@pytest.mark.parametrize('muscle', MUSCLES)
def test_every_muscle_of_the_package_can_be_controlled(muscle):
    mass = 5.0 if muscle == 'dmsp_10' else 20.0
    now = setup_of({'mass': mass}, muscle)
    low, high = now.law.reach
    l0 = now.law.joint.muscle.l0
    assert now.law.joint.muscle.kappa_min * l0 <= low < high <= now.law.joint.muscle.kappa_max * l0


def test_a_weak_muscle_has_gains_that_it_can_have():
    constants = {'a1': -0.0436, 'a2': 2.81, 'a4': -0.0927, 'a5': 3.02, 'a6': -2.64}
    weak = {**constants, 'force_max': 15.0, 'mass': 0.2}
    names, build = settings_of(weak)
    assert build(checked(names, weak)).law.gains.disturbance_bound == pytest.approx(2.0, rel=0.01)
    given = weak | {'gains.disturbance_bound': 1.5}
    names, build = settings_of(given)
    assert build(checked(names, given)).law.gains.disturbance_bound == 1.5
    wrong = weak | {'mass': -1.0}
    with pytest.raises(ParameterError, match='mass'):
        checked(settings_of(wrong)[0], wrong)


def test_the_source_of_the_velocity_is_a_gain():
    assert setup_of({'velocity_source': 'measured'}).law.gains.use_measured_velocity
    assert not setup_of({}).law.gains.use_measured_velocity
    assert 'gains.use_measured_velocity' not in table({})


def test_the_law_is_the_sliding_mode_unless_another_is_chosen():
    assert isinstance(setup_of({}).law.make_law(), SlidingMode)


def test_the_baseline_is_chosen():
    assert isinstance(setup_of({'controller': 'pid'}).law.make_law(), Pid)


@pytest.mark.parametrize(
    ('change', 'needs'),
    [
        ({'gains.bandwidth': 10.0}, False),
        ({'shape.max_velocity': 0.05}, False),
        ({'on_timeout': 'hold'}, False),
        ({'mass': 10.0}, True),
        ({'limits.pressure_high': 4e5}, True),
        ({'effects.pressure_lag.fill': 0.05}, True),
    ],
)
def test_only_another_rig_or_other_limits_need_a_new_law(change, needs):
    assert setup_of(change).law.needs_new_law(setup_of({}).law) == needs


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        ({'mass': 5e-324}, 'gives no finite pressure'),
        ({'gains.velocity_bandwidth': 1000.0}, 'too fast for a control rate of 500 Hz'),
        ({'gains.observer_bandwidth': 20.0}, 'observer_bandwidth = 20 rad/s is above bandwidth'),
        ({'limits.pressure_low': 700e3}, 'leaves no range below the p_max'),
        ({'command_timeout': 0.1, 'rate': 20.0}, 'is less than 3 periods of rate 20 Hz'),
    ],
)
def test_what_does_not_go_together_is_refused(given, sentence):
    with pytest.raises(ParameterError, match=sentence):
        setup_of(given)


@pytest.mark.parametrize(
    ('timeout', 'seconds', 'words'),
    [
        (0.5, 0.5, 'command_timeout (0.5 s)'),
        (0.0, 1.0, 'permitted with command_timeout 0 (1 s)'),
    ],
)
def test_the_longest_interruption_has_a_text(timeout, seconds, words):
    settings = setup_of({'command_timeout': timeout}).settings
    assert settings.longest_interruption == seconds
    assert settings.interruption_limit == words
