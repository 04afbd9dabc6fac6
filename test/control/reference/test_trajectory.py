# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Trajectories against the polynomials that they stand for."""

import math

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from pam_ros.control.reference.points import Point, Points
from pam_ros.control.reference.trajectory import ReferenceTrajectory
from pam_ros.control.signals import Reference
from pam_ros.errors import RangeError

REACH = (-0.01, 0.1)
HERE = Reference(0.02)


def test_positions_alone_make_the_spline_that_rests_at_both_ends():
    points = [Point(1.0, 0.04), Point(2.5, 0.03), Point(3.0, 0.05)]
    spline = CubicSpline([0, 1, 2.5, 3], [0.02, 0.04, 0.03, 0.05], bc_type='clamped')
    trajectory = ReferenceTrajectory(HERE, Points.of(points), REACH)
    for t in np.linspace(0.0, 2.999, 50):
        found = trajectory.at(t)
        assert found.position == pytest.approx(spline(t), abs=1e-14)
        assert found.velocity == pytest.approx(spline(t, 1), abs=1e-12)
        assert found.acceleration == pytest.approx(spline(t, 2), abs=1e-11)
        assert found.jerk == pytest.approx(spline(t, 3), abs=1e-10)


def test_velocities_make_cubics_and_accelerations_quintics():
    points = [Point(1.0, 0.04, 0.01), Point(2.0, 0.05, 0.0)]
    cubic = ReferenceTrajectory(HERE, Points.of(points), REACH)
    assert cubic.at(1.0 - 1e-12).velocity == pytest.approx(0.01)
    # Hermite's cubic on the first second, from rest: y = h00 y0 + h01 y1 + h11 v1.
    s = 0.3
    expected = (2 * s**3 - 3 * s**2 + 1) * 0.02 + (-2 * s**3 + 3 * s**2) * 0.04
    assert cubic.at(s).position == pytest.approx(expected + (s**3 - s**2) * 0.01)
    whole = [Point(2.0, 0.05, 0.0, 0.0)]
    quintic = ReferenceTrajectory(HERE, Points.of(whole), REACH)
    s = 0.35
    share = 10 * s**3 - 15 * s**4 + 6 * s**5
    assert quintic.at(0.7).position == pytest.approx(0.02 + 0.03 * share)
    assert quintic.at(0.7).acceleration == pytest.approx(
        0.03 / 4.0 * (60 * s - 180 * s**2 + 120 * s**3)
    )


def test_it_begins_in_the_motion_that_there_is_and_rests_at_its_end():
    moving = Reference(0.02, 0.03, 0.0)
    trajectory = ReferenceTrajectory(moving, Points.of([Point(1.0, 0.05)]), REACH)
    assert trajectory.at(0.0).velocity == pytest.approx(0.03)
    assert trajectory.at(1.0) == (pytest.approx(0.05), 0.0, 0.0, 0.0)
    assert trajectory.at(-3.0) == (pytest.approx(0.02), 0.0, 0.0, 0.0)


def test_a_point_at_the_start_takes_its_place():
    trajectory = ReferenceTrajectory(HERE, Points.of([Point(0.0, 0.03), Point(1.0, 0.05)]), REACH)
    assert trajectory.at(0.0).position == pytest.approx(0.03)
    assert ReferenceTrajectory(HERE, Points.of([Point(0.0, 0.03)]), REACH).at(
        1.0
    ).position == pytest.approx(0.03)


@pytest.mark.parametrize(
    ('points', 'named'),
    [
        ([], 'without points'),
        ([Point(1.0, math.nan)], 'not finite'),
        ([Point(1.0, 0.03), Point(1.0, 0.04)], 'point 1 of the trajectory is at 1 s'),
        ([Point(-1.0, 0.03)], 'point 0 of the trajectory is at -1 s'),
        (
            [Point(1.0, 0.2)],
            'position 0.2 m of point 0 of the trajectory is out of reach: this rig can hold its '
            'load at -0.01 to 0.1 m',
        ),
        (
            [Point(1.0, 0.09, 0.3), Point(2.0, 0.02, 0.0)],
            'position 0.105693 m of the trajectory, at 1.0625 s between its points 0 and 1, is '
            'out of reach',
        ),
    ],
)
def test_points_that_make_no_motion_are_refused(points, named):
    with pytest.raises(RangeError, match=named.replace('.', r'\.')):
        ReferenceTrajectory(HERE, Points.of(points), REACH)


@pytest.mark.parametrize(
    ('points', 'place'),
    [
        ([Point(0.4, 0.03), Point(0.5, 0.095), Point(1.0, 0.09)], 'between its points 1 and 2'),
        ([Point(0.0, 0.09), Point(0.1, 0.095), Point(1.0, 0.09)], 'between its points 1 and 2'),
        ([Point(0.5, 0.1, -0.5)], 'between its start and point 0'),
        ([Point(0.0, 0.1, 0.9, 0.0)], 'after its point 0'),
    ],
)
def test_a_motion_that_leaves_the_reach_between_points_is_named_by_its_place(points, place):
    with pytest.raises(RangeError) as refused:
        ReferenceTrajectory(HERE, Points.of(points), REACH)
    said = str(refused.value)
    assert f' s {place}, is out of reach: this rig can hold its load at -0.01 to 0.1 m' in said
    time = float(said.partition(', at ')[2].partition(' s ')[0])
    wide = ReferenceTrajectory(HERE, Points.of(points), (-1.0, 1.0))
    assert f'position {wide.at(time).position:.6g} m of the trajectory, ' in said


def test_a_place_far_into_a_long_trajectory_is_counted_from_its_first_point():
    points = [Point(0.1 * (k + 1), 0.05, 0.0) for k in range(3000)]
    points[2001] = Point(200.2, 0.099, 1.0)  # which goes on upwards
    with pytest.raises(RangeError, match=r'at 200\.20\d* s between its points 2001 and 2002,'):
        ReferenceTrajectory(Reference(0.05), Points.of(points), REACH)


@pytest.mark.parametrize(
    ('start', 'points'),
    [
        (-0.02, [Point(1.0, 0.05)]),
        (-0.02, [Point(1.0, -0.015, 0.01), Point(2.0, 0.05, 0.0)]),
        # A planner repeats the measured position, which has noise, at time 0.
        (-0.02, [Point(0.0, -0.0205, 0.0), Point(1.0, 0.05, 0.0)]),
        (0.12, [Point(0.0, 0.1205), Point(1.0, 0.05)]),
    ],
)
def test_a_start_out_of_reach_may_lead_into_it(start, points):
    trajectory = ReferenceTrajectory(Reference(start), Points.of(points), REACH)
    first = points[0].position if points[0].time == 0.0 else start
    assert trajectory.at(0.0).position == pytest.approx(first, abs=1e-12)
    assert trajectory.at(trajectory.duration).position == pytest.approx(0.05)


@pytest.mark.parametrize(
    ('start', 'points', 'named'),
    [
        (-0.02, [Point(1.0, -0.015)], 'position -0.02 m, the present reference, at which the'),
        (-0.02, [Point(0.0, -0.03), Point(1.0, 0.05)], 'position -0.03 m of point 0'),
        (-0.02, [Point(1.0, 0.05), Point(2.0, -0.015)], 'position -0.015 m of point 1'),
        (-0.02, [Point(1.0, -0.015), Point(1.5, 0.05), Point(2.0, 0.11)], '0.11 m of point 2'),
        (-0.02, [Point(0.0, -0.02, -0.2), Point(1.0, 0.05, 0.0)], 'between its points 0 and 1'),
        (-0.02, [Point(1.0, 0.12), Point(2.0, 0.05)], 'position 0.12 m of point 0'),
        (0.02, [Point(0.0, -0.0105), Point(1.0, 0.05)], 'position -0.0105 m of point 0'),
    ],
)
def test_a_motion_from_a_start_out_of_reach_must_enter_it_and_stay(start, points, named):
    with pytest.raises(RangeError, match=named.replace('.', r'\.')):
        ReferenceTrajectory(Reference(start), Points.of(points), REACH)
