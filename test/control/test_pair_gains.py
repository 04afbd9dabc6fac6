# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The gains for a pair: what suits a joint, and what does not."""

import pytest
from pam_ros.control.pair_gains import PairGains
from pam_ros.control.pair_model import PairModel
from pam_ros.rig.joint_model import JointModel

from pam_ros.control.gains import Gains
from pam_ros.errors import ParameterError

RIG = PairModel(JointModel())


def test_the_defaults_suit_the_default_joint():
    PairGains().check(RIG, 2e-3)


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
        PairGains(**given).check(RIG, period)


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        ({'velocity_bandwidth': 50.0}, 'give at least 4 times as much'),
        ({'observer_bandwidth': 40.0}, 'is above bandwidth = 25 1/s'),
        ({'disturbance_bound': 0.0}, 'disturbance_bound = 0.0 is not allowed'),
    ],
)
def test_bandwidths_out_of_order_are_refused(given, sentence):
    with pytest.raises(ParameterError, match=sentence):
        PairGains(**given)


def test_the_switching_gains_are_those_of_one_muscle_with_inertia_for_mass():
    mine = PairGains(disturbance_bound=4.0, disturbance_rate=6.0)
    other = Gains(disturbance_bound=4.0, disturbance_rate=6.0)
    assert mine.switching_gain(0.2) == other.switching_gain(0.2)
    assert mine.super_twisting(0.2) == other.super_twisting(0.2)
