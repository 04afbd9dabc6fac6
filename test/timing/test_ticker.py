# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The fixed rate on a clock that the test turns by hand."""

import pytest

from pam_ros.timing.ticker import Ticker

MS = 1_000_000


def test_due_times_are_counted_not_summed():
    ticker = Ticker(3000.0)  # a period of no whole number of ns
    ticker.start(3000.0, 5 * MS)
    now = 5 * MS
    for n in range(30_000):
        assert now == 5 * MS + round(n * 1e9 / 3000.0)
        assert ticker.remaining(now) == 0.0
        assert ticker.remaining(now - 1000) == pytest.approx(1e-6)
        ticker.tick(now)
        now += round(ticker.remaining(now) * 1e9)
    assert ticker.overruns == 0


def test_a_late_tick_does_not_move_the_next_one():
    ticker = Ticker(500.0)
    ticker.start(500.0, 0)
    ticker.tick(0)
    ticker.tick(2 * MS + 1_500_000)
    assert ticker.remaining(4 * MS) == 0.0
    assert ticker.overruns == 0


def test_aiming_moves_all_ticks_to_come():
    ticker = Ticker(500.0)
    ticker.start(500.0, 0)
    ticker.tick(0)
    ticker.aim(2 * MS + 300_000)
    for n in range(1, 5):
        due = n * 2 * MS + 300_000
        assert ticker.remaining(due) == 0.0
        ticker.tick(due)
    assert ticker.overruns == 0
    assert ticker.report(10 * MS).worst == 0.0


def test_a_tick_late_by_periods_is_one_overrun_and_keeps_the_grid():
    ticker = Ticker(500.0)
    ticker.start(500.0, 0)
    ticker.tick(0)
    ticker.tick(2 * MS + 7 * MS)
    assert ticker.overruns == 1
    assert ticker.remaining(10 * MS) == 0.0


def test_the_report_covers_the_time_since_the_last():
    ticker = Ticker(1000.0)
    ticker.start(1000.0, 0)
    for n in range(100):
        ticker.tick(n * MS + (300_000 if n == 7 else 0))
    kept = ticker.report(100 * MS)
    assert (kept.ticks, kept.overruns) == (100, 0)
    assert kept.rate == pytest.approx(1000.0)
    assert kept.worst == pytest.approx(300e-6)
    ticker.tick(100 * MS)
    again = ticker.report(150 * MS)
    assert again.ticks == 1
    assert again.span == pytest.approx(0.05)
    assert again.worst == 0.0
