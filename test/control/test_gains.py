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
from support.pair_loop import nominal

PAIR = shared(nominal())


@pytest.mark.parametrize(
    ('given', 'named'),
    [
        ({'bandwidth': 0.0}, ['bandwidth = 0.0', '0.5 to 200']),
        ({'bandwidth': math.nan}, ['bandwidth = nan']),
        ({'disturbance_bound': -1.0}, ['disturbance_bound', 'above 0']),
        ({'bandwidth': 60.0}, ['fast_bandwidth = 50', 'bandwidth = 60']),
        ({'velocity_bandwidth': 40.0}, ['velocity_bandwidth = 40', 'at least 4 times']),
        ({'observer_bandwidth': 20.0}, ['observer_bandwidth = 20', 'slower']),
    ],
)
def test_gains_that_break_a_condition_are_refused(given, named):
    with pytest.raises(ParameterError) as error:
        Gains(**given)
    for text in named:
        assert text in str(error.value)


def test_an_observer_that_is_off_needs_no_bandwidth():
    assert not Gains(observer=False, observer_bandwidth=20.0).observer


def test_gains_that_do_not_suit_a_rig_or_a_rate_are_refused():
    allocation = shared(single_muscle_joint())
    Gains().check(allocation, 0.002)
    with pytest.raises(ParameterError, match='too fast for a control rate of 50 Hz'):
        Gains().check(allocation, 0.02)
    with pytest.raises(ParameterError, match='disturbance_bound = 5000 N cannot be overcome'):
        Gains(disturbance_bound=5000.0).check(allocation, 0.002)


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


# A joint that turns ------------------------------------------------------------------------------


def test_a_joint_that_turns_has_defaults_of_its_own():
    assert Gains.for_joint(nominal()) == Gains.revolute()
    assert Gains.for_joint(single_muscle_joint()) == Gains()
    assert Gains.revolute().is_revolute
    assert Gains.revolute(bandwidth=30.0).bandwidth == 30.0
    assert Gains.revolute().disturbance_bound < Gains().disturbance_bound


def test_the_defaults_suit_the_default_pair():
    with no_error():
        Gains.revolute().check(PAIR, 2e-3)


@pytest.mark.parametrize(
    ('given', 'period', 'sentence'),
    [
        ({'disturbance_bound': 500.0}, 2e-3, 'disturbance_bound = 500 N m cannot be overcome'),
        ({'velocity_bandwidth': 1000.0}, 2e-3, 'too fast for a control rate of 500 Hz'),
        ({}, 0.05, 'too fast for a control rate of 20 Hz: give at most 30'),
    ],
)
def test_what_does_not_suit_the_joint_is_refused(given, period, sentence):
    with pytest.raises(ParameterError, match=sentence):
        Gains.revolute(**given).check(PAIR, period)


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        ({'velocity_bandwidth': 50.0}, 'give at least 4 times as much'),
        ({'observer_bandwidth': 40.0}, 'is above bandwidth = 25 1/s'),
        ({'disturbance_bound': 0.0}, 'disturbance_bound = 0.0 is not allowed'),
    ],
)
def test_bandwidths_out_of_order_are_refused_of_a_joint_that_turns(given, sentence):
    with pytest.raises(ParameterError, match=sentence):
        Gains.revolute(**given)


def test_the_switching_gain_is_that_of_one_muscle_with_inertia_for_mass():
    mine, other = Gains.revolute(disturbance_bound=4.0), Gains(disturbance_bound=4.0)
    assert mine.switching_gain(0.2) == other.switching_gain(0.2)
