# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A law in service while measurements arrive late: what is used, and a reference that waits."""

from itertools import pairwise

import pytest

from pam_ros.control.loop import BLIND, LATE, RUNNING, STOPPING, Measurement
from support.recorded_loop import PERIOD, first, recorded_loop, seen


@pytest.fixture
def loop():
    return recorded_loop()


def test_a_measurement_that_is_late_is_not_used(loop):
    used = []
    delays = 0.0, LATE, 1.1 * LATE + PERIOD, 0.09, 0.0
    for now, late in zip((1.0, 1.1, 1.2, 1.3, 1.4), delays, strict=True):
        loop.see(Measurement(now - late, 0.05))
        loop.tick(now)
        used.append(loop.law.calls[-1][2] is not None)
        loop.tick(now + PERIOD)  # it is not new any more
    assert used == [True, True, False, False, True]
    assert (loop.state, loop.starts) == (RUNNING, 1)


@pytest.mark.parametrize(('late', 'is_used'), [(0.0, True), (LATE, True), (1.01 * LATE, False)])
def test_what_arrives_late_is_not_used_although_the_step_is_within_a_period(loop, late, is_used):
    seen(loop, 1.0)
    loop.see(Measurement(1.1 - late, 0.06, late=late))
    loop.tick(1.1)
    assert (loop.law.calls[-1][2] is not None) == is_used


def test_a_measurement_that_is_later_than_the_timeout_is_none(loop):
    seen(loop, 1.0)
    loop.see(Measurement(1.19, 0.05))
    assert loop.tick(1.3) == first(1)
    assert loop.state == BLIND


def test_control_does_not_begin_at_a_measurement_that_is_late(loop):
    loop.see(Measurement(1.0, 0.05))
    assert loop.tick(1.05) is None
    assert seen(loop, 1.06, 0.04) == first(1)
    assert loop.law.starts == [(0.04, None)]
    loop.tick(1.2)
    assert loop.state == BLIND
    loop.see(Measurement(1.25, 0.03))
    assert loop.tick(1.3) == first(1)
    assert (loop.state, loop.starts) == (BLIND, 1)
    seen(loop, 1.3, 0.02)
    assert loop.law.starts[-1] == (0.02, first(1))
    assert (loop.state, loop.starts) == (RUNNING, 2)


def moved_by(loop, measured, begin, end):
    """Return how far the reference moves between two times while the load is measured at some."""
    due, places = list(measured), {}
    for n in range(round(end / PERIOD) + 1):
        now = n * PERIOD
        while due and due[0] <= now:
            loop.see(Measurement(due.pop(0), 0.05))
        loop.tick(now)
        if n == 1:
            loop.source.set_target(0.95)
        places[n] = loop.law.calls[-1][1]
    assert (loop.state, loop.starts) == (RUNNING, 1)
    return places[round(end / PERIOD)] - places[round(begin / PERIOD)]


def times(interval, count):
    return [n * interval for n in range(count)]


def is_held(loop):
    return loop.source.reference.velocity == 0.0


def test_the_reference_is_held_while_measurements_stay_away(loop):
    loop.timeout = 0.5
    assert moved_by(loop, times(0.01, 101), 1.06 + STOPPING, 1.4) == 0.0
    assert is_held(loop)
    before = loop.source.reference.position
    for n in range(1, 51):
        loop.see(Measurement(1.4 + n * PERIOD, 0.05))
        loop.tick(1.4 + n * PERIOD)
    assert before + 0.05 * 0.1 < loop.source.reference.position < before + 0.1 * 0.1
    assert loop.source.reference.velocity == pytest.approx(0.1)


def test_the_reference_stops_and_continues_without_a_jump(loop):
    loop.timeout, velocities = 0.5, []
    moved_by(loop, times(0.01, 101), 0.0, 1.0)
    for n in range(501, 700):
        now = n * PERIOD
        if n > 600:
            loop.see(Measurement(now, 0.05))
        loop.tick(now)
        velocities.append(loop.source.reference.velocity)
    assert min(velocities) == 0.0
    assert velocities[0] == velocities[-1] == pytest.approx(0.1)
    steps = [abs(b - a) for a, b in pairwise(velocities)]
    assert max(steps) <= 1.01 * 0.1 * PERIOD / STOPPING


def test_the_reference_is_held_while_measurements_arrive_too_late(loop):
    loop.timeout = 0.5
    moved_by(loop, times(0.01, 101), 0.0, 1.0)
    for n in range(501, 600):
        loop.see(Measurement(n * PERIOD - 1.1 * LATE - PERIOD, 0.05))
        loop.tick(n * PERIOD)
    assert loop.state == RUNNING
    assert is_held(loop)


@pytest.mark.parametrize(
    'measured',
    [
        times(0.1, 14),
        times(0.02, 61),
        [time for time in times(0.01, 121) if time != 0.9],  # one is lost
        [0.02 * n + (n % 2) * 0.9 * LATE for n in range(61)],
        # The rate changes.
        times(0.002, 150) + [0.3 + 0.03 * n for n in range(40)],
    ],
)
def test_the_reference_is_not_held_at_the_usual_interval(loop, measured):
    loop.timeout = 0.5
    assert moved_by(loop, measured, 0.7, 1.2) == pytest.approx(0.5 * 0.1, abs=1e-9)


def test_the_usual_interval_is_hardly_longer_after_a_pause(loop):
    loop.timeout = 0.5
    measured = [*times(0.01, 101), *(1.3 + 0.01 * n for n in range(11))]
    assert moved_by(loop, measured, 1.46 + STOPPING, 1.6) == 0.0
