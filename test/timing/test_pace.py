# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How simulated time follows the clocks, on clocks that the test turns by hand."""

import pytest

from pam_ros.timing.pace import CATCH_UP, SECOND, Pace

MS = SECOND // 1000
START = 1_700_000_000 * SECOND


class Clocks:
    """A ROS clock and a steady clock, and a simulation that does what is due."""

    def __init__(self, rate=1000.0, is_simulated=False):
        self.ros, self.steady, self.step = START, 0, 0
        self.is_simulated = is_simulated
        self.pace = Pace(rate, self.ros, self.steady)

    def passes(self, ros, steady=None):
        self.ros += ros
        self.steady += ros if steady is None else steady
        done = self.step
        self.step = self.pace.due(self.step, self.ros, self.steady, self.is_simulated)
        return self.step - done


def test_a_step_a_period_and_exact_stamps():
    clocks = Clocks(rate=3000.0)
    for _ in range(1000):
        clocks.passes(MS)
    assert clocks.step == 3000
    assert clocks.pace.stamp(3000) == START + SECOND
    assert clocks.pace.stamp(1) == START + 333_333


def test_steps_are_never_ahead_of_time():
    clocks = Clocks()
    assert clocks.passes(MS - 1) == 0
    assert clocks.passes(1) == 1
    assert clocks.passes(2 * MS + MS // 2) == 2
    assert clocks.passes(MS // 2) == 1


@pytest.mark.parametrize('is_simulated', [False, True])
def test_the_step_nearest_to_a_command_is_off_by_nothing_on_average(is_simulated):
    off = []
    for k in range(10):  # within the second step, from its beginning to its end
        late = MS + MS * (2 * k + 1) // 20
        step = Pace(1000.0, START, 0).due(0, START + late, late, is_simulated, ahead=0.5)
        off.append(step - late / MS)
    assert sum(off) == pytest.approx(0.0, abs=1e-9)
    assert max(map(abs, off)) < 0.5


def test_a_late_turn_loses_no_simulated_time():
    clocks = Clocks()
    assert clocks.passes(CATCH_UP) == 500
    assert clocks.pace.lost == 0.0
    assert clocks.pace.origin == START


def test_catching_up_is_bounded_and_skipped_periods_are_reported():
    clocks = Clocks()
    assert clocks.passes(3 * SECOND) == 500
    assert clocks.pace.lost == pytest.approx(2.5)
    # From then on simulated time and ROS time go together again.
    assert clocks.pace.stamp(clocks.step) == clocks.ros
    assert clocks.passes(10 * MS) == 10
    assert clocks.pace.jumps == 0


@pytest.mark.parametrize('jump', [3600 * SECOND, -3600 * SECOND, -SECOND // 2])
def test_a_jump_of_the_wall_clock_neither_stalls_nor_hurries(jump):
    clocks = Clocks()
    clocks.passes(100 * MS)
    assert clocks.passes(jump + 10 * MS, 10 * MS) == 10
    assert clocks.pace.stamp(clocks.step) == clocks.ros
    assert clocks.pace.jumps == 1
    assert clocks.pace.lost == 0.0
    assert clocks.passes(10 * MS) == 10


def test_a_slewed_wall_clock_is_followed_without_a_jump():
    clocks = Clocks()
    for _ in range(1000):
        clocks.passes(int(100 * MS * 1.0005), 100 * MS)
    assert clocks.step == 100_050
    assert clocks.pace.jumps == 0
    assert clocks.pace.origin == START


def test_a_clock_that_goes_back_a_little_waits():
    clocks = Clocks()
    clocks.passes(100 * MS)
    assert clocks.passes(-5 * MS, MS) == 0
    assert clocks.passes(4 * MS) == 0
    assert clocks.passes(3 * MS) == 2


def test_simulated_time_may_run_at_any_speed():
    clocks = Clocks(is_simulated=True)
    assert clocks.passes(400 * MS, MS) == 400
    assert clocks.passes(0, SECOND) == 0
    assert clocks.passes(10 * MS, 3 * SECOND) == 10
    assert clocks.pace.jumps == 0
    assert clocks.pace.lost == 0.0


@pytest.mark.parametrize('jump', [-SECOND, -MS, 1000 * SECOND])
def test_a_jump_of_simulated_time_moves_the_stamps_only(jump):
    clocks = Clocks(is_simulated=True)
    clocks.passes(100 * MS, MS)
    assert clocks.passes(jump, MS) == 0
    assert clocks.pace.stamp(clocks.step) == clocks.ros
    assert clocks.passes(20 * MS, MS) == 20


def test_the_steady_time_of_a_step_is_when_it_becomes_due():
    clocks = Clocks()
    clocks.passes(100 * MS + MS // 2)
    wait = clocks.pace.steady_time(103) - clocks.steady
    assert clocks.passes(wait - 1) == 2
    assert clocks.passes(1) == 1
    clocks.passes(-50 * MS, MS)  # the ROS clock is set back a little: it takes longer
    assert clocks.pace.steady_time(clocks.step + 1) - clocks.steady == 51 * MS


def test_align_lets_time_stand_still():
    clocks = Clocks()
    clocks.passes(100 * MS)
    clocks.ros += 60 * SECOND
    clocks.steady += 60 * SECOND
    clocks.pace.align(clocks.step, clocks.ros, clocks.steady)
    assert clocks.passes(5 * MS) == 5
    assert clocks.pace.stamp(clocks.step) == clocks.ros
    assert clocks.pace.lost == 0.0
