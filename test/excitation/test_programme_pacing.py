# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which time a programme has, on clocks that the test sets."""

import pytest

from pam_ros.excitation.programme_pacing import OneCommandPerState, OwnRate, programme_pacing
from pam_ros.timing.pace import SECOND
from pam_ros.timing.pacing import Reply
from support.steady import Steady

RECENT = 1.0  # s


@pytest.fixture
def ros():
    return Steady(20 * SECOND)


@pytest.fixture
def wall():
    return Steady()


@pytest.fixture
def followed(ros, wall):
    return OneCommandPerState(ros, wall)


@pytest.mark.parametrize(('is_simulated', 'kind'), [(False, OwnRate), (True, OneCommandPerState)])
def test_simulated_time_makes_the_programme_answer_states(ros, is_simulated, kind):
    assert type(programme_pacing(ros, is_simulated=is_simulated)) is kind


def test_on_the_wall_clock_stamps_and_their_absence_do_not_count(wall):
    pacing = OwnRate(wall)
    assert pacing.receive(20 * SECOND) == (5.0, Reply.NONE)
    wall.now += 100 * SECOND
    assert pacing.now() == pacing.start == pacing.silent_until == 105.0
    assert pacing.silence(RECENT) == ''


def test_time_is_that_of_the_newest_state(followed, ros):
    assert followed.start == followed.now() == 20.0
    assert followed.receive(19 * SECOND) == (19.0, Reply.COMMAND)
    assert (followed.start, followed.now()) == (19.0, 20.0)


def test_a_repeated_state_is_answered_with_the_last_command(followed):
    followed.receive(19 * SECOND)
    assert followed.receive(19 * SECOND) == (19.0, Reply.LAST_COMMAND)
    assert followed.receive(18 * SECOND).reply is Reply.COMMAND


def test_states_without_a_stamp_are_new_and_have_ros_time(followed):
    for _ in range(2):
        assert followed.receive(0) == (20.0, Reply.COMMAND)


def test_states_are_silent_for_the_smaller_of_two_times(followed, ros, wall):
    followed.receive(19 * SECOND)
    wall.now += SECOND // 2
    assert followed.silent_until == 19.5  # /clock is 1 s ahead of the states
    wall.now += 5 * SECOND
    assert followed.silent_until == 20.0  # /clock has stopped


def test_silence_is_measured_in_wall_time(followed, wall):
    followed.receive(19 * SECOND)
    wall.now += SECOND
    assert followed.silence(RECENT) == ''
    wall.now += SECOND // 10
    assert followed.silence(RECENT) == 'no joint_states for 1.1 s of wall time'
    followed.receive(19 * SECOND)
    assert followed.silence(RECENT) == ''
