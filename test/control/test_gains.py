# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The gains' conditions, and the bound of the error that follows from them; those of a pair."""

import math

import numpy as np
import pytest
from scipy.integrate import trapezoid
from scipy.signal import TransferFunction, impulse

from pam_ros.control.gains import Gains
from pam_ros.errors import ParameterError
from pam_ros.rig.standard_joints import single_muscle_joint
from support.assertions import no_error
from support.closed_loop import shared
from support.joint_loop import JOINTS
from support.pair_loop import nominal


@pytest.mark.parametrize(
    ('make', 'given', 'named'),
    [
        (Gains, {'bandwidth': 0.0}, ['bandwidth = 0.0', '0.5 to 200']),
        (Gains, {'bandwidth': math.nan}, ['bandwidth = nan']),
        (Gains, {'disturbance_bound': -1.0}, ['disturbance_bound', 'above 0']),
        (Gains, {'bandwidth': 60.0}, ['fast_bandwidth = 50', 'bandwidth = 60']),
        (Gains, {'velocity_bandwidth': 40.0}, ['velocity_bandwidth = 40', 'at least 4 times']),
        (Gains, {'observer_bandwidth': 20.0}, ['observer_bandwidth = 20', 'slower']),
        (Gains.revolute, {'velocity_bandwidth': 50.0}, ['give at least 4 times as much']),
        (Gains.revolute, {'observer_bandwidth': 40.0}, ['is above bandwidth = 25 1/s']),
        (Gains.revolute, {'disturbance_bound': 0.0}, ['disturbance_bound = 0.0 is not allowed']),
    ],
)
def test_gains_that_break_a_condition_are_refused(make, given, named):
    with pytest.raises(ParameterError) as error:
        make(**given)
    for text in named:
        assert text in str(error.value)


def test_an_observer_that_is_off_needs_no_bandwidth():
    assert not Gains(observer=False, observer_bandwidth=20.0).observer


@pytest.mark.parametrize(
    'joint', [single_muscle_joint(), nominal(), *JOINTS.values()], ids=['one', 'pair', *JOINTS]
)
def test_the_default_gains_suit_every_joint(joint):
    with no_error():
        Gains.for_joint(joint).check(shared(joint), 2e-3)


@pytest.mark.parametrize(
    ('joint', 'given', 'period', 'sentence'),
    [
        (single_muscle_joint(), {}, 0.02, 'too fast for a control rate of 50 Hz'),
        (single_muscle_joint(), {'disturbance_bound': 5000.0}, 2e-3, '5000 N cannot be overcome'),
        (nominal(), {'disturbance_bound': 500.0}, 2e-3, '500 N m cannot be overcome'),
        (nominal(), {'velocity_bandwidth': 1e3}, 2e-3, 'too fast for a control rate of 500 Hz'),
        (nominal(), {}, 0.05, 'too fast for a control rate of 20 Hz: give at most 30'),
    ],
)
def test_gains_that_do_not_suit_a_joint_or_a_rate_are_refused(joint, given, period, sentence):
    with pytest.raises(ParameterError, match=sentence):
        Gains.for_joint(joint, **given).check(shared(joint), period)


def test_width_and_gain_are_those_of_the_docstring():
    gains = Gains(disturbance_bound=200.0, bandwidth=16.0)
    assert gains.switching_gain(20.0) == pytest.approx(10.0)
    assert gains.boundary_width(20.0) == pytest.approx(0.625)


@pytest.mark.slow
@pytest.mark.parametrize('damping', [0.1, 0.28, 0.7, 0.99, 1.0, 1.7])
def test_the_error_bound_is_the_absolute_area_of_the_impulse_response(damping):
    w = 18.0
    gains = Gains(surface_damping=damping)
    system = TransferFunction([1.0, 0.0], [1.0, 2.0 * damping * w, w * w])
    t, h = impulse(system, T=np.linspace(0.0, 150.0 / w, 400_001))
    area = trapezoid(np.abs(h), t)
    expected = 50.0 / (20.0 * gains.bandwidth) * area
    assert gains.error_bound(50.0, 20.0, w) == pytest.approx(expected, rel=1e-4)
