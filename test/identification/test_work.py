# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The time that an identification still takes, with a clock of the test."""

import math

import pytest

from pam_ros.identification.work import LONGEST_PAUSE, MEMORY, Forecast, Work


class Clock:
    """A clock that only the test moves."""

    def __init__(self):
        self.now = 1000.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def reports():
    """Return the reports of a work: (share, text), and (low, high) in s."""
    return []


@pytest.fixture
def work(clock, reports):
    return Work(
        lambda share, text: reports.append((share, text)),
        lambda low, high: reports.append((low, high)),
        clock=clock,
    )


def simulate(work, clock, seconds, rate, pause=0.1):
    """Simulate for some *seconds* at a *rate* in time steps per s."""
    for _ in range(round(seconds / pause)):
        clock.now += pause
        work.simulated(rate * pause)


def test_no_time_is_stated_before_the_rate_is_known(work, clock, reports):
    work.step('first', Forecast(100.0, 300.0))
    simulate(work, clock, 5.0, 10.0)
    work.update()
    assert work.left() is None
    assert reports == [(0.0, 'first'), (0.0, 'first')]


def test_the_time_follows_from_the_rate_that_was_expected_and_the_one_that_is_measured(
    work, clock
):
    """With ten times the expected rate it takes a tenth of the time, once this is known."""
    work.begin_search(10.0)
    work.step('trying', Forecast(10e3, 30e3))
    assert work.left() == pytest.approx((1000.0, 3000.0))
    for _ in range(80):
        simulate(work, clock, 1.0, 100.0)
        left = work.left()
    assert left == pytest.approx((20.0, 220.0), rel=0.05)


def test_what_follows_a_part_is_added_and_its_name_precedes_the_step(work, reports):
    work.begin_search(10.0)
    with work.part('', Forecast(100.0, 200.0)), work.part('motion', Forecast(10.0, 20.0)):
        work.step('trying', Forecast(1.0, 2.0))
        work.step('confirming')
    work.step('writing', Forecast(1.0, 2.0))
    assert reports[::2] == [(11.1, 22.2), (11.1, 22.2), (0.1, 0.2)]
    assert [text for _, text in reports[1::2]] == [
        'motion: trying',
        'motion: confirming',
        'writing',
    ]


def test_reports_within_a_step_come_once_a_second(work, clock, reports):
    work.step('trying')
    for _ in range(50):
        clock.now += 0.1
        work.update()
    assert len(reports) == 1 + 5


@pytest.mark.parametrize('expected', [1e-6, 50.0, 1e9])
@pytest.mark.parametrize('forecast', [(0.0, 0.0), (0.0, 500.0), (500.0, 1e5)])
def test_the_time_left_is_never_negative_nor_unlimited_and_the_share_never_falls(
    work, clock, reports, expected, forecast
):
    work.begin_search(expected)
    for n in range(4):
        work.step(f'round {n}', Forecast(*forecast))
        for _ in range(20):
            simulate(work, clock, 2.0, 50.0)
            work.update()
    work.end()
    times, shares = reports[:-1:2], [share for share, _ in reports[1:-1:2]]
    assert all(0.0 <= low <= high < math.inf for low, high in times)
    assert shares == sorted(shares)
    assert all(0.0 <= share < 1.0 for share in shares)
    assert reports[-1] == (1.0, 'done')


def test_a_step_that_takes_longer_than_forecast_is_not_about_to_end(work, clock):
    work.begin_search(50.0)
    work.step('trying', Forecast(50.0, 500.0))
    simulate(work, clock, 310.0, 50.0)
    low, high = work.left()
    assert low == high == pytest.approx(0.2 * 300.0, rel=0.05)


def test_a_program_that_was_stopped_for_a_day_has_not_become_slower(work, clock):
    work.begin_search(50.0)
    work.step('trying', Forecast(50e3, 50e3))
    simulate(work, clock, 100.0, 50.0)
    before, _ = work.left()
    clock.now += 86400.0
    after, _ = work.left()
    assert before == pytest.approx(900.0, rel=0.01)
    assert before < after < 1.01 * before * (1.0 + LONGEST_PAUSE / MEMORY)
    for _ in range(50):
        simulate(work, clock, 1.0, 50.0)
        after, _ = work.left()
    assert after == pytest.approx(before - 50.0, rel=0.05)


# A search that is stopped ------------------------------------------------------------------------


def test_an_attempt_that_is_stopped_has_no_result_and_no_other_one_begins():
    """Simulations that belong to no attempt go on: the best model so far needs them."""
    asked = []
    work = Work(stop=lambda: asked.append(1) or len(asked) > 2)

    def simulated():
        work.simulated(1.0)
        return 'done'

    work.simulated(1.0)
    assert asked == []
    assert [work.attempt(simulated) for _ in range(4)] == ['done', 'done', None, None]
    assert len(asked) == 3
    assert work.is_stopped
    work.simulated(1.0)


def test_an_attempt_within_another_one_ends_both():
    is_requested = []
    work = Work(stop=lambda: bool(is_requested))

    def outer():
        is_requested.append(True)
        inner = work.attempt(lambda: work.simulated(1.0) or 'inner')
        work.simulated(1.0)
        return inner

    assert work.attempt(outer) is None
    assert work.is_stopped


def test_other_errors_pass_through_an_attempt():
    work = Work()
    with pytest.raises(ZeroDivisionError):
        work.attempt(lambda: 1 / 0)
    assert not work.is_stopped


def test_the_end_that_is_requested_when_the_search_has_ended_changes_nothing():
    work = Work(stop=lambda: True)
    assert work.attempt(lambda: 'done without a simulation') == 'done without a simulation'
    assert not work.is_stopped
