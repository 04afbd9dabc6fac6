# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How late messages are, on clocks that the test turns by hand."""

from itertools import pairwise

import pytest

from pam_ros.timing.delay import DRIFT, Lateness, ShortestDelay
from pam_ros.timing.pace import SECOND

MS = 1_000_000
PERIOD = 4 * MS
DELAY = 300_000  # ns that a message takes at least
AHEAD = 7_000 * SECOND  # the clock of the sensor less ours


class Rig:
    """A sensor that measures each period; ``now`` is when its last state arrived."""

    def __init__(self):
        self.measured, self.ahead, self.lateness = 50 * SECOND, AHEAD, Lateness()

    def send(self, late=0, count=1):
        """Send states that arrive *late* ns later than the fastest; return what is said."""
        return [self.arrive(late) for _ in range(count)]

    def arrive(self, late):
        self.measured += PERIOD
        self.now = self.measured + DELAY + late
        return self.lateness.of(self.measured + self.ahead, self.now)


@pytest.fixture
def rig():
    rig = Rig()
    assert rig.send(count=100) == [0] * 100
    return rig


def test_what_arrives_later_than_others_is_late_by_the_difference(rig):
    said = rig.send(80 * MS, count=10)
    # The shortest delay has risen in the time without a state, and since then.
    assert said == pytest.approx([80 * MS] * 10, abs=(80 * MS + 10 * PERIOD) // DRIFT)
    assert rig.send() == [0]


def test_a_rig_that_catches_up_is_less_and_less_late(rig):
    """It stops for 0.2 s, and then measures five times a period until none is missing."""
    said = [rig.arrive(200 * MS - 4 * n * PERIOD // 5) for n in range(60)]
    assert said[0] == pytest.approx(200 * MS, abs=(200 * MS + PERIOD) // DRIFT)
    assert all(after < before for before, after in pairwise(said))
    assert said[-1] < 4 * PERIOD


def test_without_a_stamp_nothing_is_late(rig):
    assert rig.lateness.of(0, rig.now + SECOND) == 0


@pytest.mark.parametrize('by', [3600 * SECOND, -3600 * SECOND])
def test_after_the_clock_of_the_rig_was_set_its_states_are_not_late(rig, by):
    rig.ahead += by
    assert rig.send(count=100) == [0] * 100


def test_a_delay_that_is_longer_for_good_is_the_usual_one_after_a_while(rig):
    said = rig.send(100 * MS, count=2 * DRIFT * 100 * MS // PERIOD)
    assert said[0] > 90 * MS
    assert max(said[len(said) // 2 + 1 :]) <= PERIOD // DRIFT


def test_a_clock_that_runs_slower_by_less_than_the_drift_makes_nothing_late(rig):
    for _ in range(5000):
        rig.ahead -= PERIOD // (DRIFT + 1)
        assert rig.send() == [0]


def test_a_clock_at_half_the_speed_makes_states_later_and_later(rig):
    # A rig in simulated time, whose controller is not told so.
    for _ in range(1000):
        rig.ahead -= PERIOD // 2
        said = rig.send()
    assert said == pytest.approx([1000 * (PERIOD // 2 - PERIOD // DRIFT)], rel=0.01)


def test_asking_alone_remembers_nothing():
    delay = ShortestDelay(DRIFT)
    assert delay.late(0, 5 * MS) == 0
    delay.note(0, 5 * MS)
    assert delay.late(1, 4 * MS) < 0
    assert delay.late(0, 5 * MS) == 0
