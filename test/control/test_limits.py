# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a valve is asked for, and which references are refused."""

import pytest

from pam_ros.control.limits import Limiter, Limits, refuse_unreachable
from pam_ros.errors import ParameterError, RangeError
from pam_ros.muscle.muscle import Muscle


def test_a_limiter_keeps_range_and_rate():
    limiter = Limiter(0.0, 600e3, 1e6)
    limiter.start(100e3)
    assert limiter.limit(100.5e3, 0.002) == 100.5e3
    assert limiter.limit(900e3, 0.002) == 102.5e3
    assert limiter.limit(-1e6, 0.01) == 92.5e3
    for _ in range(1000):
        limiter.limit(9e9, 0.002)
    assert limiter.last == 600e3
    limiter.start(-5.0)
    assert limiter.last == 0.0


def test_a_reference_out_of_reach_is_refused_with_the_range():
    refuse_unreachable(0.05, (-0.005, 0.0966))
    with pytest.raises(RangeError, match=r'0\.2 m is out of reach.* at -0\.005 to 0\.0966 m'):
        refuse_unreachable(0.2, (-0.005, 0.0966))


def test_limits_that_leave_nothing_are_refused():
    with pytest.raises(ParameterError, match='pressure_low = 400000 Pa is not below'):
        Limits(pressure_low=400e3, pressure_high=300e3)
    with pytest.raises(ParameterError, match='leaves no range below the p_max = 600000 Pa'):
        Limits(pressure_low=700e3).range_for(Muscle())


def test_a_highest_pressure_in_kpa_is_refused():
    muscle = Muscle()
    assert Limits(pressure_high=601.0).range_for(muscle) == (0.0, 601.0)
    with pytest.raises(ParameterError, match=r'pressure_high = 400 Pa .* is it in kPa or bar\?'):
        Limits(pressure_high=400.0).range_for(muscle)
