# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""When a programme must stop."""

import pytest

from pam_ros.excitation.guard import Guard


def guard():
    return Guard(-0.016, 0.1, 'm', silence=0.5, now=100.0)


def test_a_joint_in_its_window_with_states_continues():
    watch = guard()
    for position in (-0.016, 0.0, 0.1):
        watch.record(position, 100.2)
        assert watch.problem(100.6) == ''


@pytest.mark.parametrize('position', [-0.0161, 0.1001, 3.0])
def test_leaving_the_window(position):
    watch = guard()
    watch.record(position, 100.1)
    assert f'is at {1e3 * position:.1f} mm' in watch.problem(100.1)
    assert '-16.0 to 100.0 mm' in watch.problem(100.1)


def test_a_joint_that_turns_is_spoken_of_in_rad():
    watch = Guard(-0.5, 1.25, 'rad', silence=0.5, now=100.0)
    watch.record(1.3, 100.1)
    sentence = 'the joint is at 1.300 rad, outside its window of -0.500 to 1.250 rad'
    assert watch.problem(100.1) == sentence


@pytest.mark.parametrize('position', [float('nan'), float('inf')])
def test_a_position_that_is_no_number(position):
    watch = guard()
    watch.record(position, 100.1)
    assert str(position) in watch.problem(100.1)


def test_silence_from_the_start_and_later():
    watch = guard()
    assert watch.problem(100.4) == ''
    assert 'no joint_states for 0.60 s' in watch.problem(100.6)
    watch.record(0.0, 100.6)
    assert watch.problem(101.0) == ''
    assert 'no joint_states for 0.70 s' in watch.problem(101.3)
