# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Files with names of former versions make the joint of today's names, and say so."""

import logging

import numpy as np
import pytest

from pam_ros.effects import Hysteresis
from pam_ros.effects.maxwell_slip import ELEMENTS
from pam_ros.errors import ParameterError
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.settings.files import read
from pam_ros.settings.former_names import renamed
from pam_ros.settings.load import load_joint

FORMER, NOW = 'effects.hysteresis.slip_crowding', 'effects.hysteresis.slip_ratio'


def test_names_of_today_stay_and_need_no_sentence():
    values = {'mass': 20.0, 'effects.hysteresis.slip': 5.0, 'arm.effects.slack.share': 1.0}
    assert renamed(values) == (values, '')


@pytest.mark.parametrize('muscle', ['', 'flexor.'])
@pytest.mark.parametrize('part', ['slip', 'pressure'])
def test_both_parts_and_the_names_of_one_muscle_are_treated_alike(muscle, part):
    former = f'{muscle}effects.hysteresis.{part}_crowding'
    now = f'{muscle}effects.hysteresis.{part}_ratio'
    found, sentence = renamed({'mass': 3.0, former: 0.5})
    assert found == {'mass': 3.0, now: 4.0}
    assert sentence == f'former names of parameters: {former} is {now} = 4'


def test_a_name_of_today_is_taken_before_a_former_one():
    assert renamed({FORMER: 0.5, NOW: 20.0})[0] == {NOW: 20.0}


@pytest.mark.parametrize('crowding', [0.0, 0.2, 0.5, 0.8])
def test_crowded_thresholds_become_the_nearest_with_a_ratio(crowding):
    ratio = renamed({FORMER: crowding})[0][NOW]
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
        renamed({FORMER: value})


@pytest.fixture
def file(tmp_path):
    def made(values):
        path = tmp_path / 'of_0_1_0.yaml'
        lines = [f'    {name}: {value}' for name, value in values.items()]
        path.write_text('\n'.join(['/**:', '  ros__parameters:', '    mass: 20.0', *lines]))
        return path

    return made


def test_a_file_makes_the_joint_of_today_and_says_so_once(file, caplog):
    path = file({'effects.hysteresis.slip': 5.0, FORMER: 0.5})
    with caplog.at_level(logging.WARNING, 'pam_ros'):
        joints = [load_joint(path) for _ in range(2)]
    expected = single_muscle_joint(effects=[Hysteresis(slip=5.0, slip_ratio=4.0)])
    assert joints[0].actuators[0].effects == expected.actuators[0].effects
    assert joints[1] == joints[0]
    assert caplog.messages == [f'{path}: former names of parameters: {FORMER} is {NOW} = 4']


def test_a_file_with_a_former_value_out_of_range_is_refused_with_its_name(file):
    path = file({FORMER: 1.5})
    with pytest.raises(ParameterError, match=f'{path}: {FORMER} = 1.5 is not allowed'):
        read(path)
