# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Set-points, streams and trajectories, and the reach that limits them."""

import math

import numpy as np
import pytest

from pam_ros.control.reference.points import Point, Points
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.reference.source import ReferenceSource
from pam_ros.errors import RangeError

DT, REACH, REST = 0.002, (0.0, 0.09), 0.06
TURN, SWING = math.pi, 0.005  # rad/s, m


@pytest.fixture
def source():
    source = ReferenceSource(Shape(), REACH)
    source.start(REST)
    follow(source, 1.0)
    return source


def follow(source, seconds):
    return np.array([source.follow(DT).position for _ in range(round(seconds / DT))])


@pytest.mark.parametrize('gap', [0.15, 0.3, 0.6, 2.5])
@pytest.mark.parametrize('goal', [0.072, 0.085])
def test_set_points_one_after_the_other_are_not_taken_for_a_motion(source, gap, goal):
    source.set_target(0.07)
    follow(source, gap)
    source.set_target(goal)
    way = follow(source, 4.0)
    assert np.max(way) < goal + 1e-3
    assert way[-1] == pytest.approx(goal, abs=1e-9)


@pytest.mark.parametrize('gap', [0.02, 0.05, 0.09])
def test_what_seems_a_motion_does_not_lead_out_of_reach(source, gap):
    source.set_target(0.08)
    follow(source, gap)
    source.set_target(0.089)
    way = follow(source, 4.0)
    assert np.max(way) <= REACH[1]
    assert way[-1] == pytest.approx(0.089, abs=1e-9)


def test_a_load_that_rests_out_of_reach_is_held_there(source):
    source.start(-0.01)
    np.testing.assert_array_equal(follow(source, 0.1), -0.01)


@pytest.mark.parametrize(('rate', 'most'), [(100, 5e-6), (20, 0.2e-3)])
def test_a_stream_is_followed_without_lag(source, rate, most):
    way, wanted = [], []
    for n in range(2000):
        if n % (500 // rate) == 0:
            source.set_target(REST + SWING * math.sin(TURN * n * DT))
        way.append(source.follow(DT).position)
        wanted.append(REST + SWING * math.sin(TURN * (n + 1) * DT))
    assert np.max(np.abs(np.subtract(way, wanted)[1000:])) < most


def test_a_trajectory_that_begins_in_motion_is_followed_at_once(source):
    times = np.linspace(0.05, 4.0, 80)
    points = [
        Point(t, REST + SWING * math.sin(TURN * t), SWING * TURN * math.cos(TURN * t))
        for t in times
    ]
    source.play(Points.of(points))
    way = follow(source, 3.9)
    wanted = REST + SWING * np.sin(TURN * DT * np.arange(1, way.size + 1))
    assert np.max(np.abs(way - wanted)) < 0.3e-3


def test_a_refused_position_changes_nothing(source):
    for bad in (0.1, math.nan, math.inf):
        with pytest.raises(RangeError):
            source.set_target(bad)
    np.testing.assert_array_equal(follow(source, 0.1), REST)


# After another source, whose reach may differ ----------------------------------------------------

LOW = (0.0, 0.03)  # m, the reach with less pressure


def successor(before, reach, position):
    source = ReferenceSource(Shape(), reach)
    return source, source.succeed(before, position)


def test_a_reference_within_both_reaches_stays_where_it_is(source):
    after, sentence = successor(source, (0.01, 0.07), 0.055)
    assert sentence == ''
    np.testing.assert_array_equal(follow(after, 0.1), REST)


def test_a_reference_out_of_the_new_reach_goes_from_the_load_into_the_reach(source):
    after, sentence = successor(source, LOW, 0.058)
    assert sentence == (
        'reference 0.06 m is out of reach with the changed parameters: this rig can hold its load '
        'at 0 to 0.03 m; the reference starts at the position of the load, 0.058 m'
    )
    way = follow(after, 2.0)
    assert way[0] == pytest.approx(0.058, abs=1e-6)
    assert np.max(np.abs(np.diff(way))) <= 1.001 * Shape().max_velocity * DT
    assert way[-1] == LOW[1]
    # From there it continues as within any reach.
    again, sentence = successor(after, REACH, 0.0295)
    assert sentence == ''
    np.testing.assert_array_equal(follow(again, 0.1), LOW[1])


def test_where_the_load_is_within_the_new_reach_it_is_held(source):
    after, sentence = successor(source, LOW, 0.02)
    assert 'starts at the position of the load, 0.02 m' in sentence
    np.testing.assert_array_equal(follow(after, 0.1), 0.02)


def test_a_trajectory_out_of_the_new_reach_ends(source):
    source.start(0.02)
    source.play(Points.of([Point(2.0, REST)]))
    follow(source, 1.9)
    after, sentence = successor(source, LOW, 0.05)
    assert 'out of reach' in sentence
    assert not after.is_on_trajectory
    assert follow(after, 2.0)[-1] == LOW[1]


def test_a_reference_on_its_way_into_the_reach_starts_at_the_load_if_the_reach_grows():
    before = ReferenceSource(Shape(), LOW)
    before.start(REST)
    before.set_target(0.03)
    assert follow(before, 0.1)[-1] > LOW[1]
    after, sentence = successor(before, REACH, 0.04)
    assert sentence == ''
    np.testing.assert_array_equal(follow(after, 0.1), 0.04)


def test_a_load_that_rests_out_of_reach_stays_there_with_another_reach(source):
    source.start(-0.01)
    after, sentence = successor(source, LOW, -0.0101)
    assert sentence == ''
    np.testing.assert_array_equal(follow(after, 1.0), -0.0101)


def test_a_reference_that_leaves_such_a_place_goes_into_the_new_reach(source):
    source.start(-0.01)
    source.set_target(0.02)
    follow(source, 0.05)
    after, _ = successor(source, LOW, -0.0099)
    assert follow(after, 1.0)[-1] == LOW[0]
