# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Interruptions of a process, on clocks that the test turns by hand."""

import time

import pytest

from pam_ros.timing.interruption import PATIENCE, SETTLE, Interruptions, steady_ns
from pam_ros.timing.pace import SECOND

MS = 1_000_000
PERIOD = 2 * MS
LONGEST = SECOND
BEHIND = -7_000 * SECOND  # the clock of the sensor less ours
DELAY = 300_000  # ns that a message takes


class Bench:
    """A process that does its work each period, and a sensor next to it that measures each one."""

    def __init__(self):
        self.now = 50 * SECOND
        self.interruptions = Interruptions(self.now)

    def run(self, span):
        """Work, and receive what is measured; return which messages were old."""
        old = []
        for _ in range(span // PERIOD):
            self.now += PERIOD
            assert not self.interruptions.find(self.now, LONGEST)
            old.append(self.receive(self.now - DELAY))
            self.interruptions.mark(self.now)
        return old

    def receive(self, measured):
        return self.interruptions.is_old('joint_states', measured + BEHIND, self.now)

    def sleep(self, span):
        self.now += span
        return self.interruptions.find(self.now, LONGEST)


@pytest.fixture
def bench():
    bench = Bench()
    assert not any(bench.run(SECOND))
    return bench


def test_an_interruption_is_found_once_with_its_length(bench):
    assert bench.sleep(LONGEST) == 0
    assert bench.sleep(1) == LONGEST + 1
    assert bench.sleep(10 * MS) == 0


def test_an_interruption_in_the_middle_of_the_work_is_found_once(bench):
    begun = bench.now
    assert bench.sleep(3 * SECOND)
    bench.interruptions.mark(begun)
    assert bench.sleep(PERIOD) == 0
    assert bench.interruptions.is_settling


def test_turns_without_work_are_one_interruption(bench):
    # It is delayed twice, and does no work in between: no command was sent during all this time.
    assert bench.sleep(600 * MS) == 0
    assert bench.sleep(600 * MS) == 1200 * MS


def test_what_was_queued_is_old_and_what_is_measured_later_is_not(bench):
    slept, woke = bench.now, bench.now + 3 * SECOND
    bench.sleep(3 * SECOND)
    queued = range(slept, woke, 100 * MS)
    assert all(bench.receive(measured) for measured in queued)
    old = bench.run(SETTLE + 100 * MS)
    settled = SETTLE // PERIOD
    assert all(old[:settled])
    assert not any(old[settled:])
    # On a busy machine the queue may be longer still.
    assert all(bench.receive(measured) for measured in queued)


def test_without_stamps_messages_are_new_when_the_queue_has_arrived(bench):
    bench.sleep(3 * SECOND)
    assert bench.interruptions.is_old('pressures', 0, bench.now)
    bench.run(SETTLE)
    assert not bench.interruptions.is_old('pressures', 0, bench.now)


def test_while_it_is_delayed_again_no_time_passes_in_which_the_queue_arrives(bench):
    bench.sleep(3 * SECOND)
    assert bench.sleep(900 * MS) == 0
    bench.interruptions.mark(bench.now)
    assert bench.interruptions.is_old('pressures', 0, bench.now)


def test_stamps_of_a_clock_that_was_set_back_are_not_old_for_ever(bench):
    bench.sleep(3 * SECOND)
    bench.run(SETTLE)
    assert bench.receive(bench.now - 3600 * SECOND)
    bench.run(PATIENCE)
    assert not bench.receive(bench.now - 3600 * SECOND)


def test_clocks_that_part_slowly_are_followed(bench):
    # 200 ppm for an hour: the sensor's clock is 0.7 s behind what it was.
    for _ in range(3600):
        bench.now += SECOND
        bench.interruptions.mark(bench.now)
        behind = (bench.now - 51 * SECOND) // 5000
        assert not bench.receive(bench.now - DELAY - behind)
    bench.sleep(3 * SECOND)
    woke = bench.now
    bench.now += SETTLE
    for _ in range(SETTLE // (100 * MS)):
        bench.interruptions.mark(bench.now)
        bench.now += 100 * MS
    assert bench.receive(woke - 50 * MS - behind)
    assert not bench.receive(woke + 50 * MS - behind)


@pytest.mark.skipif(not hasattr(time, 'CLOCK_BOOTTIME'), reason='Linux has this clock')
def test_the_clock_counts_while_the_machine_sleeps():
    before = time.clock_gettime_ns(time.CLOCK_BOOTTIME)
    now = steady_ns()
    assert before <= now <= time.clock_gettime_ns(time.CLOCK_BOOTTIME)


def test_elsewhere_it_is_the_steady_clock(monkeypatch):
    monkeypatch.delattr(time, 'CLOCK_BOOTTIME', raising=False)
    before = time.monotonic_ns()
    assert before <= steady_ns() <= time.monotonic_ns()
