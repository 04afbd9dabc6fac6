# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A goal ends by the rules of FollowJointTrajectory, with the numbers that decide."""

import math

import pytest

from pam_ros.control.goal import Goal, Outcome, Tolerance, Tolerances
from pam_ros.control.reference.points import Point, Points
from pam_ros.control.reference.trajectory import ReferenceTrajectory
from pam_ros.control.signals import Reference
from pam_ros.errors import RangeError

START = 100.0  # s by the clock of the loop
# 10 mm in 2 s, at rest at both ends: 3 s^2 - 2 s^3 with s = t / 2 s.
TRAJECTORY = ReferenceTrajectory(
    Reference(0.05), Points.of([Point(0.0, 0.05, 0.0), Point(2.0, 0.06, 0.0)]), (0.0, 0.1)
)


def goal(path=None, end=None, goal_time_tolerance=0.0):
    return Goal(
        TRAJECTORY,
        START,
        'm',
        Tolerances(path or Tolerance(), end or Tolerance(), goal_time_tolerance),
    )


def test_the_target_is_that_of_the_trajectory():
    target = goal().target(START + 1.0)
    assert target.position == pytest.approx(0.055)
    assert target.velocity == pytest.approx(0.01 * 1.5 / 2.0)
    assert goal().target(START - 1.0) == Reference(0.05)
    assert goal().target(START + 9.0).position == pytest.approx(0.06)
    assert goal().since(START + 9.0) == 9.0


def test_without_tolerances_it_is_reached_at_its_end():
    for now in (START - 3.0, START, START + 1.999):
        assert goal().judge(now, 0.02, -1.0) is None
    outcome, text = goal().judge(START + 2.004, 0.02, -1.0)
    assert outcome is Outcome.REACHED
    assert text == 'reached 0.004 s after the end of the trajectory'


def test_the_path_holds_from_the_start_to_the_end():
    one = goal(path=Tolerance(0.001, 0.002))
    assert one.judge(START - 0.5, 0.09, 0.0) is None  # it waits
    assert one.judge(START + 1.0, 0.0559, 0.0075) is None
    outcome, text = one.judge(START + 1.0, 0.0562, 0.0075)
    assert outcome is Outcome.OFF_PATH
    assert text == 'the error of the position is -0.0012 m, more than 0.001 m, 1 s after the start'
    outcome, text = one.judge(START + 1.0, 0.055, 0.0)
    assert outcome is Outcome.OFF_PATH
    assert text.startswith('the error of the velocity is 0.0075 m/s, more than 0.002 m/s')
    assert one.judge(START + 2.5, 0.09, 0.0).outcome is Outcome.REACHED


def test_the_end_is_reached_within_its_tolerance_or_missed_after_the_leeway():
    one = goal(end=Tolerance(0.001), goal_time_tolerance=1.0)
    assert one.judge(START + 1.0, 0.02, 0.0) is None
    assert one.judge(START + 2.9, 0.058, 0.0) is None
    assert one.judge(START + 2.9, 0.0591, 0.0).outcome is Outcome.REACHED
    outcome, text = one.judge(START + 3.1, 0.058, 0.0)
    assert outcome is Outcome.MISSED
    assert text.startswith('the error of the position is 0.002 m, more than 0.001 m, 1.1 s after')
    assert goal(end=Tolerance(0.001)).judge(START + 1e4, 0.058, 0.0) is None  # no limit


def test_a_state_that_is_no_number_is_in_no_tolerance():
    assert goal(path=Tolerance(0.001)).judge(START + 1.0, math.nan, 0.0) is not None
    assert goal(end=Tolerance(0.001)).judge(START + 3.0, math.nan, 0.0) is None


def test_a_tolerance_that_is_erased_permits_every_error():
    assert goal(path=Tolerance(-1.0, -1.0)).judge(START + 1.0, 9.0, 9.0) is None
    assert goal(end=Tolerance(-1.0)).judge(START + 2.0, 9.0, 9.0).outcome is Outcome.REACHED


@pytest.mark.parametrize('bad', [-0.5, math.nan, math.inf])
def test_other_values_are_refused(bad):
    with pytest.raises(RangeError, match='a tolerance of the velocity of'):
        Tolerance(velocity=bad)
    if not bad > 0.0:
        with pytest.raises(RangeError, match='goal_time_tolerance'):
            goal(goal_time_tolerance=bad)


def test_the_unit_is_that_of_the_joint():
    one = Goal(TRAJECTORY, START, 'rad', Tolerances(path=Tolerance(0.001, 0.001)))
    assert ' rad, more than 0.001 rad,' in one.judge(START + 1.0, 0.0, 0.0).text
