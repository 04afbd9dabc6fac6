# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Two lines solved for two pressures, put into the equations again."""

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from pam_ros.rig import pair
from pam_ros.rig.pair import Line

effort = st.floats(-50.0, 50.0)
gain = st.floats(1e-6, 1e-3)
stiff = st.floats(0.1, 100.0)
LIMITS = ((1e5, 6e5), (0.5e5, 5e5))


def lines(a, b, c, d):
    """Return a muscle that pulls one way, and one that pulls the other."""
    return Line(a[0], b[0], c[0], d[0]), Line(a[1], -b[1], c[1], d[1])


both = st.builds(
    lines,
    st.tuples(effort, effort),
    st.tuples(gain, gain),
    st.tuples(stiff, stiff),
    st.tuples(gain, gain),
)


@given(both, effort, stiff)
def test_both_pressures_give_effort_and_stiffness(two, tau, k):
    one, other = two
    p, q = pair.pressures(one, other, tau, k)
    scale = abs(one.b * p) + abs(other.b * q) + abs(one.a) + abs(other.a) + 1.0
    assert one.a + one.b * p + other.a + other.b * q == pytest.approx(tau, abs=1e-9 * scale)
    scale = abs(one.d * p) + abs(other.d * q) + one.c + other.c
    assert one.c + one.d * p + other.c + other.d * q == pytest.approx(k, abs=1e-9 * scale)
    assert pair.other(one, other, tau, p) == pytest.approx(q, rel=1e-6, abs=1.0)


@given(both, effort, st.floats(0.0, 1.0))
def test_the_piece_is_what_the_limits_leave_of_the_line(two, tau, share):
    one, other = two
    low, high = pair.piece(one, other, tau, LIMITS)
    assume(low < high)
    p = low + share * (high - low)
    q = pair.other(one, other, tau, p)
    (a, b), (c, d) = LIMITS
    assert a <= p <= b
    assert c - 1.0 <= q <= d + 1.0
    # Beyond its ends one of them is out of its limits.
    for beyond in (low - 10.0, high + 10.0):
        q = pair.other(one, other, tau, beyond)
        assert not (a < beyond < b and c < q < d)
    k = pair.stiffness_at(one, other, tau, p)
    assert pair.pressures(one, other, tau, k)[0] == pytest.approx(p, rel=1e-6, abs=1.0)


def test_equal_muscles_that_pull_in_the_same_direction_have_no_free_stiffness():
    one = Line(-3.0, 1e-4, 5.0, 2e-5)
    assert pair.is_settled(one, one)
    assert not pair.is_settled(one, one._replace(b=-1e-4))


def test_slack_is_where_the_effort_vanishes():
    line = Line(-3.0, 1e-4, 5.0, 2e-5)
    assert line.a + line.b * line.slack == pytest.approx(0.0, abs=1e-12)
