# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings that are made of arrays are checked like those that are read."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.identification.data.checked import checked
from pam_ros.identification.identify import identify
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.bounds import Bounds
from pam_ros.recording.recording import Recording
from pam_ros.rig.loads import Mass
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint

JOINT = single_muscle_joint(Muscle(), Mass(mass=20.0))
T = np.arange(0.0, 20.0, 0.02)
COMMAND = 300e3 + 120e3 * np.sin(2.0 * np.pi * 0.2 * T) + 60e3 * np.sin(1.7 * T)


@pytest.fixture(scope='module')
def good():
    noise = np.random.default_rng(1).normal(0.0, 20e-6, T.size)
    y = simulate(JOINT, T, COMMAND).position + noise
    return Recording('made', T, T, COMMAND, y)


def test_the_bounds_of_one_muscle_on_a_mass():
    muscle = JOINT.muscle
    assert JOINT.bounds == Bounds(muscle.l0, (muscle.p_max,), None, 'm')


def test_a_known_force_has_no_length():
    volts = {'pressure_unit': 'Pa', 'p_min': -10.0, 'p_max': 10.0, 'force_max': 500.0}
    motor = Muscle(0.0, 0.0, 0.0, 0.0, 35.15, 0.0, zeta=0.0, **volts)
    drive = single_muscle_joint(motor, Mass(95.0, 'horizontal'))
    assert drive.bounds == Bounds(None, (10.0,), None, 'm')


def test_the_reach_of_a_joint_is_where_its_muscles_have_a_length():
    muscle = Muscle(l0=0.4)
    joint = antagonistic_joint(muscle, radius=0.05, contraction=(0.05, 0.1))
    # Contractions of -0.2 to 0.95 of 0.4 m at a radius of 0.05 m, from 0.05 and 0.1 at angle 0.
    low, high = joint.bounds.reach
    assert low == pytest.approx(-0.25 * 0.4 / 0.05)
    assert high == pytest.approx(0.3 * 0.4 / 0.05)
    assert joint.bounds.l0 is None


def test_good_data_have_no_warning_and_are_not_changed(good):
    assert checked(good, JOINT).warnings == ()
    np.testing.assert_array_equal(checked(good, JOINT).position, good.position)


def test_each_warning_appears_once(good):
    doubtful = replace(good, position=0.1 - good.position, warnings=('of the sensor',))
    once = checked(doubtful, JOINT)
    assert once.warnings[0] == 'of the sensor'
    assert 'position falls where pressure_command rises' in once.warnings[1]
    assert checked(once, JOINT).warnings == once.warnings


@pytest.mark.parametrize(
    ('change', 'sentence'),
    [
        ({'t': 1e3 * T, 'command_t': 1e3 * T}, r'samples are 20 s apart.*another unit \(t_ms'),
        ({'command': 1e-3 * COMMAND}, r'p_max of the muscle is .* another unit'),
        ({'command': np.full(T.size, 3e5)}, 'constant at 300000 Pa, so that no parameter can be'),
        ({'position': np.full(T.size, 0.03)}, 'position is constant while'),
        ({'position': np.linspace(10.0, 40.0, T.size)}, 'position'),
    ],
    ids=['ms', 'kPa', 'constant command', 'constant position', 'mm'],
)
def test_arrays_that_cannot_be_right_are_refused_before_the_fit(good, change, sentence):
    bad = replace(good, **change)
    with pytest.raises(RecordingError, match=f'made: .*{sentence}'):
        identify(JOINT, [bad])
    with pytest.raises(RecordingError, match=f'made: .*{sentence}'):
        identify(JOINT, [good], [bad])
