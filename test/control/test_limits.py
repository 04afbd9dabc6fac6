# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a valve is asked for, and where a load can be held."""

import pytest
from pam_ros.rig.model import Load, RigModel

from pam_ros.control.limits import Limiter, Limits, reachable, refuse_unreachable
from pam_ros.errors import ParameterError, RangeError
from pam_ros.muscle.muscle import Muscle
from support.bench import cart, rest


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


def test_the_reach_is_that_of_the_muscles_curve():
    model = RigModel(Muscle(), Load(mass=20.0))
    low, high = reachable(model, Limits())
    assert low == pytest.approx(rest(0.02 * 600e3, model.weight), abs=1e-6)
    assert high == pytest.approx(rest(0.98 * 600e3, model.weight), abs=1e-6)
    # A light load is bounded by the contraction that the maker permits.
    assert reachable(RigModel(load=Load(mass=2.0)), Limits())[1] == pytest.approx(0.25 * 0.4)
    narrow = Limits(pressure_low=200e3, pressure_high=300e3)
    low, high = reachable(model, narrow)
    assert low == pytest.approx(rest(202e3, model.weight), abs=1e-6)
    assert high == pytest.approx(rest(298e3, model.weight), abs=1e-6)


def test_a_load_without_a_muscle_has_no_bounds():
    low, high = reachable(cart(), Limits())
    assert (low, high) == (-float('inf'), float('inf'))


def test_a_reference_out_of_reach_is_refused_with_the_range():
    refuse_unreachable(0.05, (-0.005, 0.0966))
    with pytest.raises(RangeError, match=r'0\.2 m is out of reach.* at -0\.005 to 0\.0966 m'):
        refuse_unreachable(0.2, (-0.005, 0.0966))


def test_limits_that_leave_nothing_are_refused():
    with pytest.raises(ParameterError, match='pressure_low = 400000 Pa is not below'):
        Limits(pressure_low=400e3, pressure_high=300e3)
    with pytest.raises(ParameterError, match='leaves no range below the p_max = 600000 Pa'):
        Limits(pressure_low=700e3).range_for(RigModel())
    heavy = RigModel(load=Load(mass=130.0))
    with pytest.raises(ParameterError, match='cannot be held anywhere'):
        reachable(heavy, Limits(pressure_high=100e3))
