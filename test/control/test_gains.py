# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The gains' conditions, and the bound of the error that follows from them."""

import math

import numpy as np
import pytest
from pam_ros.rig.model import Load, RigModel
from scipy.integrate import trapezoid
from scipy.signal import TransferFunction, impulse

from pam_ros.control.gains import Gains
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle


@pytest.mark.parametrize(
    ('given', 'named'),
    [
        ({'bandwidth': 0.0}, ['bandwidth = 0.0', '0.5 to 200']),
        ({'bandwidth': math.nan}, ['bandwidth = nan']),
        ({'disturbance_bound': -1.0}, ['disturbance_bound', 'above 0']),
        ({'switching': 'hard'}, ['switching', 'boundary_layer', 'super_twisting']),
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
    model = RigModel(Muscle(), Load())
    Gains().check(model, 0.002)
    with pytest.raises(ParameterError, match='too fast for a control rate of 50 Hz'):
        Gains().check(model, 0.02)
    with pytest.raises(ParameterError, match='disturbance_bound = 5000 N cannot be overcome'):
        Gains(disturbance_bound=5000.0).check(model, 0.002)


def test_width_and_gain_are_those_of_the_docstring():
    gains = Gains(disturbance_bound=200.0, bandwidth=16.0)
    assert gains.switching_gain(20.0) == pytest.approx(10.0)
    assert gains.boundary_width(20.0) == pytest.approx(0.625)
    k1, k2 = Gains(disturbance_rate=80.0).super_twisting(20.0)
    assert (k1, k2) == (pytest.approx(3.0), pytest.approx(4.4))


@pytest.mark.parametrize('damping', [0.1, 0.28, 0.7, 0.99, 1.0, 1.7])
def test_the_error_bound_is_the_absolute_area_of_the_impulse_response(damping):
    w = 18.0
    gains = Gains(surface_damping=damping)
    system = TransferFunction([1.0, 0.0], [1.0, 2.0 * damping * w, w * w])
    t, h = impulse(system, T=np.linspace(0.0, 150.0 / w, 400_001))
    area = trapezoid(np.abs(h), t)
    expected = 50.0 / (20.0 * gains.bandwidth) * area
    assert gains.error_bound(50.0, 20.0, w) == pytest.approx(expected, rel=1e-4)
