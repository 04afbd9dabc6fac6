# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One smooth reference of all targets that are set."""

import math

import numpy as np
import pytest

from pam_ros.control.reference.points import Point, Points
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.reference.source import MOST_WAITING, ReferenceSource
from pam_ros.control.signals import Reference
from pam_ros.errors import RangeError

DT = 2e-3
SHAPE = Shape()


def a_source():
    source = ReferenceSource(SHAPE, (-0.01, 0.1))
    source.start(0.02)
    return source


def follow(source, seconds):
    return np.array([source.follow(DT) for _ in range(round(seconds / DT))])


def is_smooth(path, most=20.0):
    """Say whether velocity never jumps: by a few times the bound of acceleration at most."""
    return np.max(np.abs(np.diff(path[:, 1]))) <= most * SHAPE.max_acceleration * DT


def test_it_holds_until_a_target_is_set():
    assert np.all(follow(a_source(), 0.1) == [0.02, 0.0, 0.0, 0.0])


def test_a_trajectory_interrupts_a_step_and_a_step_a_trajectory():
    source = a_source()
    source.set_target(0.08)
    first = follow(source, 0.2)
    source.play(Points.of([Point(1.0, 0.05), Point(2.0, 0.03)]))
    second = follow(source, 1.3)
    assert source.is_on_trajectory
    source.set_target(0.06)
    third = follow(source, 2.0)
    assert not source.is_on_trajectory
    assert is_smooth(np.vstack([first, second, third]))
    assert third[-1].tolist() == [0.06, 0.0, 0.0, 0.0]


def test_a_trajectory_is_passed_on_exactly_and_held_at_its_end():
    source = a_source()
    source.play(Points.of([Point(2.0, 0.05, 0.0, 0.0)]))
    path = follow(source, 2.5)
    s = np.clip((np.arange(len(path)) + 1) * DT / 2.0, 0.0, 1.0)
    np.testing.assert_allclose(path[:, 0], 0.02 + 0.03 * (10 * s**3 - 15 * s**4 + 6 * s**5))
    assert path[-1].tolist() == [pytest.approx(0.05), 0.0, 0.0, 0.0]
    assert not source.is_on_trajectory


def test_it_waits_for_a_start_in_the_future_and_joins_one_in_the_past():
    late, early = a_source(), a_source()
    points = [Point(0.0, 0.02), Point(1.0, 0.05)]
    late.play(Points.of(points), wait=0.5)
    early.play(Points.of(points), wait=-0.5)
    assert follow(late, 0.5)[-1, 0] == pytest.approx(0.02)
    assert follow(late, 1.0)[-1, 0] == pytest.approx(0.05)
    path = follow(early, 1.5)
    assert path[0, 0] == pytest.approx(0.02, abs=1e-3)
    assert path[-1, 0] == pytest.approx(0.05)
    assert is_smooth(path)


def test_the_present_motion_continues_until_the_next_trajectory_begins():
    source, other = a_source(), a_source()
    for one in (source, other):
        one.play(Points.of([Point(2.0, 0.08, 0.0, 0.0)]))
        follow(one, 0.5)
    source.play(Points.of([Point(1.0, 0.05, 0.0, 0.0)]), wait=0.4)
    before = follow(source, 0.4)
    np.testing.assert_array_equal(before, follow(other, 0.4))
    path = follow(source, 1.0)
    assert is_smooth(np.vstack([before, path]))
    assert path[-1, 0] == pytest.approx(0.05, abs=1e-6)
    assert not source.is_on_trajectory


def test_a_receding_horizon_of_trajectories_that_begin_later_moves_the_joint():
    # A planner that sends each 100 ms the motion from 200 ms later on.
    source = a_source()
    planned = a_source()
    planned.play(Points.of([Point(3.0, 0.08, 0.0, 0.0)]))
    motion = [planned.reference, *follow(planned, 4.0)[49::50]]
    paths = []
    for k in range(35):
        ahead = [Point(0.1 * n, *motion[min(k + 2 + n, 40)][:3]) for n in range(11)]
        source.play(Points.of(ahead), wait=0.2)
        paths.append(follow(source, 0.1))
    path = np.vstack(paths)
    assert is_smooth(path)
    assert np.all(path[:100, 0] == 0.02)  # nothing has begun yet
    np.testing.assert_allclose(path[299::50, :2], np.array(motion)[6:36, :2], atol=1e-4)


def test_what_begins_later_is_replaced_and_a_target_replaces_all():
    source = a_source()
    source.play(Points.of([Point(1.0, 0.08)]), wait=1.0)
    source.play(Points.of([Point(1.0, 0.05)]), wait=0.5)
    assert source.is_on_trajectory
    assert follow(source, 3.0)[-1, 0] == pytest.approx(0.05)
    source.play(Points.of([Point(1.0, 0.08)]), wait=1.0)
    source.set_target(0.04)
    assert not source.is_on_trajectory
    assert follow(source, 4.0)[-1, 0] == pytest.approx(0.04)
    source.play(Points.of([Point(1.0, 0.08)]), wait=1.0)
    source.stop()
    assert follow(source, 3.0)[-1, 0] == pytest.approx(0.04)
    for k in range(MOST_WAITING):
        source.play(Points.of([Point(1.0, 0.05)]), wait=1.0 + k)
    with pytest.raises(RangeError, match='1000 trajectories wait for their start'):
        source.play(Points.of([Point(1.0, 0.05)]), wait=2000.0)


def test_a_trajectory_goes_on_while_nobody_looks():
    source, other = a_source(), a_source()
    for one in (source, other):
        one.play(Points.of([Point(3.0, 0.08)]))
    first = follow(source, 1.0)
    missed = source.follow(0.1, 0.3)  # which is 0.4 s in all
    last = follow(source, 1.6)
    assert abs(missed.position - first[-1, 0]) < 0.1 * SHAPE.max_velocity
    assert abs(missed.velocity - first[-1, 1]) < 2.0 * 0.1 * SHAPE.max_acceleration
    assert is_smooth(np.vstack([missed, last]))
    np.testing.assert_allclose(last[-1], follow(other, 3.0)[-1], atol=1e-9)


def test_a_step_waits_while_nobody_looks():
    source, other = a_source(), a_source()
    for one in (source, other):
        one.set_target(0.05)
    source.follow(DT, 0.3)
    assert source.reference == other.follow(DT)


def test_an_approach_is_slowed_and_held_and_then_the_same():
    source, other = a_source(), a_source()
    for one in (source, other):
        one.set_target(0.05)
        follow(one, 0.3)
    before, slow, whole = source.reference, source.follow(2.0 * DT, pace=0.5), other.follow(DT)
    assert slow.position == whole.position
    assert slow.velocity == pytest.approx(0.5 * whole.velocity)
    assert slow.acceleration == pytest.approx(0.25 * whole.acceleration)
    assert slow.position > before.position
    held = source.follow(0.3, pace=0.0)
    assert held == Reference(slow.position)
    assert source.follow(DT) == other.follow(DT)


def test_a_trajectory_is_neither_slowed_nor_held():
    source, other = a_source(), a_source()
    for one in (source, other):
        one.play(Points.of([Point(3.0, 0.08)]))
    for pace in (1.0, 0.5, 0.0):
        assert source.follow(0.2, pace=pace) == other.follow(0.2)


def test_a_target_that_moves_is_neither_slowed_nor_held():
    source, other = a_source(), a_source()
    for one, pace in ((source, 0.0), (other, 1.0)):
        for n in range(400):
            if n % 5 == 0:
                one.set_target(0.03 - 0.01 * math.cos(3.0 * n * DT))
            one.follow(DT, pace=1.0 if n < 300 else pace)
    assert source.reference == other.reference


def test_a_trajectory_can_be_stopped():
    source = a_source()
    source.play(Points.of([Point(2.0, 0.08)]))
    follow(source, 1.0)
    source.stop()
    path = follow(source, 1.0)
    assert path[-1, 1] == 0.0
    assert path[-1, 0] < 0.07
    assert is_smooth(path)


def test_what_cannot_be_is_refused_and_changes_nothing():
    source = a_source()
    source.play(Points.of([Point(2.0, 0.05)]))
    for bad in (0.2, -0.5, math.nan, math.inf):
        with pytest.raises(RangeError, match=rf'reference {bad}.* its load at -0.01 to 0.1 m'):
            source.set_target(bad)
    with pytest.raises(RangeError):
        source.play(Points.of([Point(1.0, 0.3)]))
    assert source.is_on_trajectory
    follow(source, 2.5)
    assert source.reference.position == pytest.approx(0.05)


def test_each_target_is_counted():
    source = a_source()
    seen = [source.targets]
    for set_one in (
        lambda: source.set_target(0.05),
        lambda: source.play(Points.of([Point(1.0, 0.05)])),
        source.stop,
        lambda: source.start(0.03),
    ):
        set_one()
        seen.append(source.targets)
    assert len(set(seen)) == len(seen)
    follow(source, 2.0)
    with pytest.raises(RangeError):
        source.set_target(0.5)
    assert source.targets == seen[-1]


# Set-points and streams, and the reach that limits them ------------------------------------------

REACH, REST = (0.0, 0.09), 0.06


@pytest.fixture
def source():
    source = ReferenceSource(Shape(), REACH)
    source.start(REST)
    positions(source, 1.0)
    return source


def positions(source, seconds):
    return np.array([source.follow(DT).position for _ in range(round(seconds / DT))])


@pytest.mark.parametrize(
    ('first', 'gap', 'goal', 'most'),
    [
        *((0.07, gap, 0.072, 0.073) for gap in (0.15, 0.3, 0.6, 2.5)),
        *((0.07, gap, 0.085, 0.086) for gap in (0.15, 0.3, 0.6, 2.5)),
        *((0.08, gap, 0.089, REACH[1]) for gap in (0.02, 0.05, 0.09)),  # which seem a motion
    ],
)
def test_set_points_one_after_the_other_lead_beyond_neither_goal_nor_reach(
    source, first, gap, goal, most
):
    source.set_target(first)
    positions(source, gap)
    source.set_target(goal)
    way = positions(source, 4.0)
    assert np.max(way) <= most
    assert way[-1] == pytest.approx(goal, abs=1e-9)


def test_a_load_that_rests_out_of_reach_is_held_there(source):
    source.start(-0.01)
    np.testing.assert_array_equal(positions(source, 0.1), -0.01)


# After another source, whose reach may differ ----------------------------------------------------

LOW = (0.0, 0.03)  # m, the reach with less pressure


def successor(before, reach, position):
    source = ReferenceSource(Shape(), reach)
    return source, source.succeed(before, position)


def test_a_reference_within_both_reaches_stays_where_it_is(source):
    after, sentence = successor(source, (0.01, 0.07), 0.055)
    assert sentence == ''
    np.testing.assert_array_equal(positions(after, 0.1), REST)


def test_a_reference_out_of_the_new_reach_goes_from_the_load_into_the_reach(source):
    after, sentence = successor(source, LOW, 0.058)
    assert sentence == (
        'reference 0.06 m is out of reach with the changed parameters: this rig can hold its load '
        'at 0 to 0.03 m; the reference starts at the position of the load, 0.058 m'
    )
    way = positions(after, 2.0)
    assert way[0] == pytest.approx(0.058, abs=1e-6)
    assert np.max(np.abs(np.diff(way))) <= 1.001 * Shape().max_velocity * DT
    assert way[-1] == LOW[1]
    # From there it continues as within any reach.
    again, sentence = successor(after, REACH, 0.0295)
    assert sentence == ''
    np.testing.assert_array_equal(positions(again, 0.1), LOW[1])


def test_where_the_load_is_within_the_new_reach_it_is_held(source):
    after, sentence = successor(source, LOW, 0.02)
    assert 'starts at the position of the load, 0.02 m' in sentence
    np.testing.assert_array_equal(positions(after, 0.1), 0.02)


def test_a_trajectory_out_of_the_new_reach_ends(source):
    source.start(0.02)
    source.play(Points.of([Point(2.0, REST)]))
    positions(source, 1.9)
    after, sentence = successor(source, LOW, 0.05)
    assert 'out of reach' in sentence
    assert not after.is_on_trajectory
    assert positions(after, 2.0)[-1] == LOW[1]


def test_a_reference_on_its_way_into_the_reach_starts_at_the_load_if_the_reach_grows():
    before = ReferenceSource(Shape(), LOW)
    before.start(REST)
    before.set_target(0.03)
    assert positions(before, 0.1)[-1] > LOW[1]
    after, sentence = successor(before, REACH, 0.04)
    assert sentence == ''
    np.testing.assert_array_equal(positions(after, 0.1), 0.04)


def test_a_load_that_rests_out_of_reach_stays_there_with_another_reach(source):
    source.start(-0.01)
    after, sentence = successor(source, LOW, -0.0101)
    assert sentence == ''
    np.testing.assert_array_equal(positions(after, 1.0), -0.0101)


def test_a_reference_that_leaves_such_a_place_goes_into_the_new_reach(source):
    source.start(-0.01)
    source.set_target(0.02)
    positions(source, 0.05)
    after, _ = successor(source, LOW, -0.0099)
    assert positions(after, 1.0)[-1] == LOW[0]
