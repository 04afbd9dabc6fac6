# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated time between two messages of /clock, at its jumps and at its ends."""

import pytest

from pam_ros.recording.simulated_time import KEPT, SimulatedTime

SECOND = 10**9


@pytest.fixture
def five_times_as_fast():
    time = SimulatedTime()
    for n in range(4):  # every 2 ms, 10 ms of simulated time
        time.tell(100 * SECOND + n * 2_000_000, SECOND + n * 10_000_000)
    return time


def test_between_two_times_it_passes_evenly(five_times_as_fast):
    assert five_times_as_fast.at(100 * SECOND) == SECOND
    assert five_times_as_fast.at(100 * SECOND + 500_000) == SECOND + 2_500_000
    assert five_times_as_fast.at(100 * SECOND + 3_000_000) == SECOND + 15_000_000


def test_after_the_last_time_it_is_not_known_yet(five_times_as_fast):
    late = 100 * SECOND + 6_100_000
    assert five_times_as_fast.at(late) is None
    assert five_times_as_fast.before(late) == SECOND + 30_000_000
    five_times_as_fast.tell(100 * SECOND + 8_000_000, SECOND + 40_000_000)
    assert five_times_as_fast.at(late) == SECOND + 30_500_000


def test_the_newest_time_is_the_one_that_was_sent_last():
    time = SimulatedTime()
    assert time.newest is None
    time.tell(20, 500)
    time.tell(10, 900)
    assert time.newest == 20


def test_before_the_first_time_it_is_the_first(five_times_as_fast):
    assert five_times_as_fast.at(99 * SECOND) == SECOND
    assert five_times_as_fast.before(99 * SECOND) == 0


def test_where_time_stands_still_or_restarts_nothing_is_interpolated():
    time = SimulatedTime()
    for sent, now in ((10, 500), (20, 500), (30, 100)):
        time.tell(sent, now)
    assert [time.at(sent) for sent in (15, 25)] == [500, 500]
    assert time.at(30) is None


def test_what_comes_out_of_order_is_left_out():
    time = SimulatedTime()
    time.tell(20, 200)
    time.tell(10, 900)
    time.tell(30, 300)
    assert time.at(25) == 250


def test_the_past_is_forgotten_but_not_the_present():
    time = SimulatedTime()
    for n in range(5 * KEPT):
        time.tell(n * 10, n * 100)
    assert time.at(5 * KEPT * 10 - 15) == 5 * KEPT * 100 - 150
