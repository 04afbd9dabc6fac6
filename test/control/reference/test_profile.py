# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The quickest way to rest against closed forms, and its bounds from any state."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.control.reference.profile import (
    JerkLimitedMotion,
    MotionLimits,
    advance,
    change,
    to_rest,
)

BOUNDS = MotionLimits(0.1, 0.5, 6.0)


def ends(state, pieces):
    for jerk, duration in pieces:
        assert duration >= 0.0
        state = advance(state, jerk, duration)
    return state


def duration(pieces):
    return sum(piece.duration for piece in pieces)


def test_a_short_distance_takes_four_segments_of_jerk():
    # Rest to rest by jerk alone: x = j (T/4)^3 2, so T = (32 x / j)^(1/3).
    x = 1e-3
    assert duration(to_rest((x, 0.0, 0.0), BOUNDS)) == pytest.approx((32.0 * x / 6.0) ** (1 / 3))


def test_a_long_distance_is_travelled_at_the_velocity_bound():
    # x / v + v / a + a / j for a way on which both bounds are met.
    x = 0.2
    expected = x / 0.1 + 0.1 / 0.5 + 0.5 / 6.0
    assert duration(to_rest((-x, 0.0, 0.0), BOUNDS)) == pytest.approx(expected)


@given(
    x=st.floats(-0.3, 0.3),
    v=st.floats(-0.1, 0.1),
    a=st.floats(-0.5, 0.5),
)
def test_it_ends_at_rest_at_zero_from_anywhere(x, v, a):
    assert ends((x, v, a), to_rest((x, v, a), BOUNDS)) == pytest.approx((0, 0, 0), abs=1e-9)


@given(
    x=st.floats(-0.3, 0.3),
    v=st.floats(-0.05, 0.05),
    a=st.floats(-0.2, 0.2),
)
def test_bounds_hold_during_the_motion(x, v, a):
    rest = JerkLimitedMotion()
    rest.begin((x, v, a), BOUNDS)
    before = (x, v, a)
    for _ in range(4000):
        now = rest.follow(2e-3)
        assert abs(now[1]) <= BOUNDS.velocity + 1e-9
        assert abs(now[2]) <= BOUNDS.acceleration + 1e-9
        assert abs(now[2] - before[2]) <= BOUNDS.jerk * 2e-3 + 1e-9
        assert abs(now[0] - before[0]) <= BOUNDS.velocity * 2e-3 + 1e-9
        before = now
        if now == (0.0, 0.0, 0.0):
            break
    assert before == (0.0, 0.0, 0.0)


@given(v=st.floats(-1.0, 1.0), a=st.floats(-2.0, 2.0), wanted=st.floats(-0.1, 0.1))
def test_a_change_of_velocity_ends_there_without_acceleration(v, a, wanted):
    _, speed, acceleration = ends((0.0, v, a), change(v, a, wanted, BOUNDS))
    assert speed == pytest.approx(wanted, abs=1e-9)
    assert acceleration == pytest.approx(0.0, abs=1e-9)
