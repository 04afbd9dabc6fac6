# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pressures that are probably not in Pa are mentioned in a warning, and others are not."""

import warnings

import numpy as np
import pytest

from pam_ros import antagonistic_joint, equilibrium, linearise, load_joint, simulate
from pam_ros.muscle.pressure_unit import is_low

T = np.linspace(0.0, 0.1, 11)


@pytest.mark.parametrize(
    ('pressure', 'text'),
    [(300.0, 'reaches 300 Pa only, .* in kPa or bar'), (3e7, 'the force law is not valid there')],
)
@pytest.mark.parametrize('function', [equilibrium, linearise])
def test_a_rest_position_warns_where_the_caller_is(function, pressure, text):
    with pytest.warns(UserWarning, match=text) as found:
        function(load_joint('dmsp_20_400n'), pressure)
    assert [one.filename for one in found] == [__file__]


def test_a_run_warns_of_its_commands_once():
    with pytest.warns(UserWarning, match='command reaches 450 Pa only') as found:
        simulate(load_joint('dmsp_20_400n'), T, np.full(T.size, 450.0))
    assert [one.filename for one in found] == [__file__]


def test_pressures_of_a_muscle_are_no_mistake():
    joint, pair = load_joint('dmsp_20_400n'), antagonistic_joint()
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter('always')
        equilibrium(joint, 0.0)
        equilibrium(joint, 600e3)
        equilibrium(pair, (200.0, 300e3))
        simulate(joint, T, np.linspace(0.0, 300e3, T.size))  # a ramp begins with low ones
    assert not found


def test_the_bound_of_low_ones():
    assert is_low(600.0, 600e3)
    assert not is_low(601.0, 600e3)
    assert not is_low(0.0, 600e3)
