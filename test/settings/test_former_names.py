# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Files with names of former versions make the joint of today's names, and say so."""

import logging

import numpy as np
import pytest

from pam_ros.effects import Hysteresis, Leak, PressureHysteresis
from pam_ros.effects.maxwell_slip import ELEMENTS
from pam_ros.errors import ParameterError
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.settings.files import read
from pam_ros.settings.former_names import renamed
from pam_ros.settings.load import load_joint

OLD = {
    'effects.hysteresis.slip': 5.0,
    'effects.hysteresis.pressure': 4e3,
    'effects.hysteresis.pressure_width': 2e4,
    'effects.hysteresis.pressure_onset': 0.2,
    'effects.hysteresis.initial': 0.1,
}


def test_names_of_today_stay_and_need_no_sentence():
    values = {'mass': 20.0, 'effects.hysteresis.slip': 5.0, 'arm.effects.slack.share': 1.0}
    assert renamed(values) == (values, '')


def test_hysteresis_over_pressure_is_an_effect_of_its_own():
    found, sentence = renamed(OLD)
    assert found == {
        'effects.hysteresis.slip': 5.0,
        'effects.pressure_hysteresis.slip': 4e3,
        'effects.pressure_hysteresis.slip_width': 2e4,
        'effects.pressure_hysteresis.slip_onset': 0.2,
        'effects.hysteresis.initial': 0.1,
        'effects.pressure_hysteresis.initial': 0.1,
    }
    assert sentence == (
        'former names of parameters: '
        'effects.hysteresis.pressure is effects.pressure_hysteresis.slip, '
        'effects.hysteresis.pressure_width is effects.pressure_hysteresis.slip_width, '
        'effects.hysteresis.pressure_onset is effects.pressure_hysteresis.slip_onset'
    )


def test_the_names_of_one_muscle_are_treated_alike():
    found, _ = renamed({f'flexor.{name}': value for name, value in OLD.items()})
    assert found['flexor.effects.pressure_hysteresis.slip'] == 4e3
    assert found['flexor.effects.pressure_hysteresis.initial'] == 0.1
    assert not any('hysteresis.pressure' in name for name in found)


def test_a_moment_at_which_it_begins_holds_for_both_parts():
    found, _ = renamed({**OLD, 'effects.hysteresis.onset': 3.0})
    assert found['effects.pressure_hysteresis.onset'] == 3.0
    assert found['effects.hysteresis.onset'] == 3.0


def test_a_name_of_today_is_taken_before_a_former_one():
    now = 'effects.pressure_hysteresis.slip'
    found, sentence = renamed({**OLD, now: 1e3})
    assert found[now] == 1e3
    assert f'effects.hysteresis.pressure is ignored, since {now} is given' in sentence


def test_a_ratio_of_the_thresholds_over_pressure_moves_as_it_is():
    found, _ = renamed({'effects.hysteresis.pressure_ratio': 20.0})
    assert found == {'effects.pressure_hysteresis.slip_ratio': 20.0}


@pytest.mark.parametrize('crowding', [0.0, 0.2, 0.5, 0.8])
def test_crowded_thresholds_become_the_nearest_with_a_ratio(crowding):
    name = 'effects.hysteresis.slip_crowding'
    found, sentence = renamed({name: crowding})
    ((now, ratio),) = found.items()
    assert now == 'effects.hysteresis.slip_ratio'
    assert sentence.endswith(f'{name} is {now} = {ratio:g}')
    s = (np.arange(ELEMENTS) + 0.5) / ELEMENTS
    before = s * (1.0 - crowding) / (1.0 - crowding * s)
    after = s if ratio == 1.0 else (ratio**s - 1.0) / (ratio - 1.0)
    x = np.linspace(0.0, 1.2, 500)[:, None]
    loops = [np.minimum(x / d, 1.0).mean(axis=1) for d in (before, after)]
    assert np.abs(loops[0] - loops[1]).max() < 0.04
    assert np.array_equal(before, after) == (crowding == 0.0)


@pytest.mark.parametrize('value', [-0.1, 0.99, 'many', None])
def test_a_crowding_out_of_range_is_refused_by_its_former_name(value):
    with pytest.raises(ParameterError, match=r'slip_crowding = .*: give 0 to 0\.98'):
        renamed({'effects.hysteresis.slip_crowding': value})


@pytest.mark.parametrize('of', ['', 'flexor.'])
def test_a_parameter_that_is_a_constant_now_is_left_out(of):
    constants = {
        'leak.lost': 0.0,
        'leak.reopening': 2e3,
        'hysteresis.unloading': 1.0,
        'hysteresis.pressure_growth': 0.0,
    }
    same = {f'{of}effects.{name}': value for name, value in constants.items()}
    assert renamed({**same, 'mass': 20.0}) == ({'mass': 20.0}, '')


@pytest.mark.parametrize('value', [0.3, 'many'])
def test_another_value_of_a_constant_is_named(value):
    name = 'effects.leak.lost'
    assert renamed({name: value, 'effects.leak.rate': 0.1}) == (
        {'effects.leak.rate': 0.1},
        f'former names of parameters: {name} = {value} is ignored: it is always 0',
    )


@pytest.fixture
def file(tmp_path):
    def made(values):
        path = tmp_path / 'of_0_1_0.yaml'
        lines = [f'    {name}: {value}' for name, value in values.items()]
        path.write_text('\n'.join(['/**:', '  ros__parameters:', '    mass: 20.0', *lines]))
        return path

    return made


def test_a_file_makes_the_joint_with_both_effects_and_one_warning(file, caplog):
    path = file(OLD)
    with caplog.at_level(logging.WARNING, 'pam_ros'):
        joints = [load_joint(path) for _ in range(2)]
    over_p = PressureHysteresis(slip=4e3, slip_width=2e4, slip_onset=0.2, initial=0.1)
    expected = single_muscle_joint(effects=[Hysteresis(slip=5.0, initial=0.1), over_p])
    assert joints[0].actuators[0].effects == expected.actuators[0].effects
    assert joints[1] == joints[0]
    (message,) = caplog.messages
    assert message.startswith(f'{path}: former names of parameters: effects.hysteresis.pressure')


def test_a_file_with_a_former_parameter_makes_the_joint_of_its_constant(file, caplog):
    path = file({'effects.leak.rate': 0.1, 'effects.leak.reopening': 3e3})
    with caplog.at_level(logging.WARNING, 'pam_ros'):
        joint = load_joint(path)
    assert joint.actuators[0].effects == (Leak(rate=0.1),)
    (message,) = caplog.messages
    assert message.endswith('effects.leak.reopening = 3000.0 is ignored: it is always 2000')


def test_a_file_with_a_former_value_out_of_range_is_refused_with_its_name(file):
    path = file({'effects.hysteresis.pressure_crowding': 1.5})
    with pytest.raises(ParameterError, match=f'{path}: .*pressure_crowding = 1.5 is not allowed'):
        read(path)
