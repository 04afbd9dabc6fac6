# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the valve makes of any number whatever."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.devices.pressure_input import PressureInput
from pam_ros.muscle.muscle import Muscle

MUSCLE = Muscle()


@given(st.lists(st.floats()))
def test_what_is_applied_is_a_number_within_the_limits(values):
    valve = PressureInput(MUSCLE)
    for value in values:
        applied = valve.take(value)
        if math.isfinite(value):
            assert applied == min(max(value, 0.0), 600e3)
            assert valve.last == value
        else:
            assert applied is None
    finite = [v for v in values if math.isfinite(v)]
    assert valve.accepted == len(finite)
    assert valve.refused == len(values) - len(finite)
    assert valve.clamped == sum(not 0.0 <= v <= 600e3 for v in finite)


@pytest.mark.parametrize(
    ('value', 'reason'),
    [
        (math.nan, 'pressure command nan is not finite: the last valid one remains active'),
        (-1.5, 'pressure command -1.5 Pa is outside 0 to 600000: clamped'),
        (7e5, 'pressure command 700000 Pa is outside 0 to 600000: clamped'),
    ],
)
def test_the_reason_names_the_value(value, reason):
    valve = PressureInput(MUSCLE)
    valve.take(1e5)
    assert valve.reason == ''
    valve.take(value)
    assert valve.reason == reason
    valve.take(1e5)
    assert valve.reason == reason  # the last one there was


def test_a_vacuum_is_allowed_where_the_muscle_allows_it():
    valve = PressureInput(Muscle(p_min=-10e3, kappa_max=0.1))
    assert valve.take(-5e3) == -5e3
    assert valve.take(-25e3) == -10e3
