# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""When a loop steps and which time it has, on clocks that the test sets."""

from dataclasses import dataclass, replace

import pytest

from pam_ros.timing.interruption import SETTLE
from pam_ros.timing.loop_pacing import (
    LATE,
    LONG,
    WATCH_RATE,
    Arrival,
    OneStepPerState,
    OwnRate,
    Step,
    Use,
    loop_pacing,
)
from pam_ros.timing.pace import SECOND
from pam_ros.timing.pacing import Reply
from support.steady import Steady

MS = SECOND // 1000
STAMP = 70 * SECOND


@dataclass(frozen=True)
class Settings:
    rate: float = 500.0
    state_timeout: float = 0.1
    longest_interruption: float = 1.0


@pytest.fixture
def ros():
    return Steady(90 * SECOND)


@pytest.fixture
def wall():
    return Steady()


@pytest.fixture
def own(ros, wall):
    return OwnRate(Settings(), ros, wall)


@pytest.fixture
def followed(ros, wall):
    return OneStepPerState(Settings(), ros, wall)


@pytest.fixture(params=['own', 'followed'])
def pacing(request):
    return request.getfixturevalue(request.param)


def receive(pacing, stamp):
    arrival = pacing.arrive(stamp)
    pacing.use(arrival)
    return arrival


@pytest.mark.parametrize(('is_simulated', 'kind'), [(False, OwnRate), (True, OneStepPerState)])
def test_simulated_time_makes_the_loop_answer_states(ros, is_simulated, kind):
    assert type(loop_pacing(Settings(), ros, is_simulated=is_simulated)) is kind


def test_the_rate_is_that_of_the_settings_or_that_of_the_states(own, followed):
    for pacing in own, followed:
        pacing.change(Settings(rate=200.0))
    assert (own.tick_rate, own.wanted_rate) == (200.0, 200.0)
    assert (followed.tick_rate, followed.wanted_rate) == (WATCH_RATE, None)


# States --------------------------------------------------------------------------------------


def test_on_the_wall_clock_a_state_has_its_time_of_receipt_less_its_lateness(own, wall):
    assert own.arrive(STAMP) == Arrival(wall.now, wall.now, Reply.NONE)
    wall.now += 50 * MS
    in_time = wall.now - 40 * MS  # its delay is longer by 40 ms, less the drift in 50 ms
    late = own.arrive(STAMP + 10 * MS)
    assert late.late == pytest.approx(40 * MS, abs=50 * MS / 20)
    assert late.time == late.received == pytest.approx(in_time, abs=50 * MS / 20)


def test_on_the_wall_clock_neither_pauses_nor_jumps_of_stamps_count(own):
    for stamp in STAMP, STAMP + 100 * SECOND, STAMP - SECOND, 0:
        arrival = own.arrive(stamp)
        assert (arrival.pause, arrival.is_earlier, arrival.reply) == (0, False, Reply.NONE)


def test_a_state_that_is_followed_has_the_time_of_its_stamp(followed, wall):
    assert followed.arrive(STAMP) == Arrival(STAMP, wall.now, Reply.COMMAND)
    longest = STAMP + SECOND
    assert followed.arrive(longest).pause == 0
    assert followed.arrive(longest + SECOND + 1).pause == SECOND + 1
    arrival = followed.arrive(STAMP)
    assert (arrival.is_earlier, arrival.pause) == (True, 0)


def test_a_repeated_state_is_not_a_new_one(pacing, wall):
    pacing.arrive(STAMP)
    arrival = pacing.arrive(STAMP)
    assert arrival.is_repeated
    assert arrival.reply is (Reply.LAST_COMMAND if pacing.answers_states else Reply.NONE)
    pacing.note_command()
    assert pacing.arrive(STAMP).reply is Reply.NONE
    pacing.arrive(0)
    assert not pacing.arrive(0).is_repeated  # without stamps they cannot be told apart


def test_a_state_is_fresh_until_the_timeout(pacing, ros, wall):
    receive(pacing, ros.now)
    for clock in ros, wall:
        clock.now += 100 * MS
    assert pacing.is_fresh()
    assert pacing.age == 0.1
    for clock in ros, wall:
        clock.now += 1
    assert not pacing.is_fresh()
    pacing.change(Settings(state_timeout=0.2))
    assert pacing.is_fresh()


def test_a_state_that_is_not_usable_does_not_count_as_seen(pacing, ros, wall):
    receive(pacing, ros.now)
    for clock in ros, wall:
        clock.now += 101 * MS
    pacing.arrive(ros.now - 101 * MS + 1)
    assert not pacing.is_fresh()


def test_a_state_that_is_followed_is_as_old_as_the_smaller_of_two_times(followed, ros, wall):
    receive(followed, ros.now)
    wall.now += SECOND
    assert followed.is_fresh()  # /clock has stopped
    wall.now -= SECOND
    ros.now += SECOND
    assert followed.is_fresh()  # /clock is ahead of the states


def test_a_stamp_that_lasts_is_named_when_the_state_is_too_old(pacing, ros, wall):
    receive(pacing, ros.now)
    stamp = ros.now
    for clock in ros, wall:
        clock.now += 50 * MS
    pacing.arrive(stamp)
    for clock in ros, wall:
        clock.now += SECOND
    assert pacing.repeated_stamp is None  # it has stopped, and repeated the last one before
    pacing.arrive(stamp)
    assert pacing.repeated_stamp == stamp
    stamp = ros.now
    receive(pacing, stamp)
    for clock in ros, wall:
        clock.now += 60 * MS
    pacing.arrive(stamp)
    assert pacing.repeated_stamp is None  # it is not too old yet


def test_a_state_is_forgotten(pacing):
    assert (pacing.stamp, pacing.age) == (None, None)
    pacing.arrive(STAMP)
    assert pacing.stamp == STAMP
    pacing.forget()
    assert (pacing.stamp, pacing.age) == (None, None)


# Steps ---------------------------------------------------------------------------------------


@pytest.mark.parametrize('is_waiting', [False, True])
def test_each_tick_of_the_wall_clock_is_a_step(own, ros, wall, is_waiting):
    receive(own, STAMP)
    assert own.due(wall.now, is_waiting=is_waiting) == Step(5.0, ros.now)
    assert own.answer() is None


def test_a_tick_that_follows_states_is_a_step_only_if_they_are_missing(followed, ros, wall):
    assert followed.due(wall.now, is_waiting=True) is followed.answer() is None
    receive(followed, ros.now)
    answer = Step(ros.now / SECOND, ros.now)
    assert followed.answer() == answer
    assert followed.due(wall.now, is_waiting=False) is None
    assert followed.due(wall.now, is_waiting=True) == answer
    for clock in ros, wall:
        clock.now += SECOND
    for is_waiting in False, True:
        assert followed.due(wall.now, is_waiting=is_waiting) == Step(91.0, 91 * SECOND)


@pytest.mark.parametrize(
    ('settings', 'longest'),
    [
        (Settings(state_timeout=1.0), LATE),
        (Settings(state_timeout=0.04), 0.02),
        (Settings(rate=50.0), 0.06),
    ],
)
def test_a_late_tick_receives_messages_first_but_not_twice_in_a_row(own, wall, settings, longest):
    own.change(settings)
    at = wall.now
    found = []
    for late in 0, 1, 1, 1, 0, 0:
        at += round(longest * SECOND) + late
        found.append(own.receives_first(at))
    assert found == [False, True, False, True, False, False]


def test_a_tick_that_follows_states_is_never_too_late(followed, wall):
    assert not followed.receives_first(wall.now + 100 * SECOND)


def test_a_reference_waits_from_the_last_step_of_the_loop(own, followed, ros, wall):
    stepped = wall.now / SECOND
    wall.now += 3 * MS
    ros.now += 3 * MS
    assert own.wait_until(ros.now + SECOND, stepped) == pytest.approx(1.003)
    followed.arrive(ros.now - 10 * MS)
    assert followed.wait_until(ros.now + SECOND, stepped) == pytest.approx(1.010)


# Interruptions -------------------------------------------------------------------------------


def test_on_the_wall_clock_control_starts_again_after_an_interruption(own, wall):
    wall.now += SECOND
    assert own.interruption() == 0
    wall.now += 1
    assert own.interruption() == SECOND + 1
    assert own.use_of('joint_states', STAMP) is Use.NEVER
    assert own.is_settling


def test_after_an_interruption_the_newest_state_that_is_followed_is_used_later(followed, wall):
    wall.now += LONG
    followed.interruption()
    assert followed.use_of('joint_states', STAMP) is Use.NOW
    wall.now += 1
    assert followed.interruption() == 0  # the time between two states shows it
    assert followed.use_of('joint_states', STAMP) is Use.LATER


def test_measurements_are_used_again_when_all_queued_messages_have_arrived(pacing, wall):
    pacing.change(replace(Settings(), longest_interruption=0.1))
    wall.now += SECOND
    pacing.interruption()
    for _ in range(4):
        wall.now += SETTLE // 4
        assert pacing.is_settling
        pacing.mark(wall.now)
    assert not pacing.is_settling
    assert pacing.use_of('joint_states', 0) is Use.NOW
