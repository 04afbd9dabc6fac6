# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The time modes of the simulator, on clocks that the test sets."""

import sys
from types import SimpleNamespace

import pytest

from pam_ros.settings.scene import Scene
from pam_ros.settings.sim import SimSettings
from pam_ros.settings.tables import checked
from pam_ros.simulator import modes
from pam_ros.simulator.modes import FIRST, GAP, Lockstep, RealTime, Scaled, mode_of
from pam_ros.simulator.turns import SETTLE, Turns
from pam_ros.timing.pace import CATCH_UP, SECOND
from support.steady import Steady

MS = SECOND // 1000
NEXT = 10  # step of the next sample


class RosClock:
    """A clock of rclpy, as far as it is used."""

    def __init__(self, *, is_active):
        self.ros_time_is_active = is_active
        self.ns = 7 * SECOND

    def now(self):
        return SimpleNamespace(nanoseconds=self.ns)


@pytest.fixture
def wall():
    return Steady()


def scaled(wall, factor):
    return Scaled(SimSettings(time_mode='scaled', speed_factor=factor, publish_rate=500.0), wall)


def lockstep(wall, muscles=1):
    turns = Turns(muscles, frozenset, wall)
    return Lockstep(SimSettings(time_mode='lockstep', publish_rate=100.0), turns, wall)


# Real time -----------------------------------------------------------------------------------


@pytest.mark.parametrize('is_simulated', [False, True])
def test_steps_follow_ros_time_and_have_its_stamps(wall, monkeypatch, is_simulated):
    clock = RosClock(is_active=is_simulated)
    monkeypatch.setattr(modes, 'time_ns', lambda: clock.ns)
    mode = RealTime(SimSettings(), clock, wall)
    assert (mode.makes_time, mode.follows_clock, mode.speed) == (False, is_simulated, 1.0)
    origin = clock.ns
    assert mode.due(0, NEXT) == 0
    clock.ns += 30 * MS
    wall.now += 30 * MS
    assert mode.due(0, NEXT) == 30
    assert mode.stamp(30) == origin + 30 * MS
    clock.ns += MS // 2
    wall.now += MS // 2
    assert mode.due(30, NEXT) == 30
    assert mode.due(30, NEXT, ahead=0.5) == 31
    # The next tick is at the time of the step, if ROS time passes as the steady clock does.
    assert mode.wakes(31) == (None if is_simulated else wall.now + MS // 2)


def test_a_jump_of_the_systems_time_is_counted_and_not_simulated(wall, monkeypatch):
    clock = RosClock(is_active=False)
    monkeypatch.setattr(modes, 'time_ns', lambda: clock.ns)
    mode = RealTime(SimSettings(), clock, wall)
    clock.ns += 3600 * SECOND
    wall.now += 10 * MS
    assert mode.due(0, NEXT) == 10
    assert (mode.jumps, mode.lost) == (1, 0.0)
    wall.now += 3 * SECOND
    clock.ns += 3 * SECOND
    assert mode.due(10, NEXT) == 10 + CATCH_UP // MS
    assert mode.lost == pytest.approx(2.5)


def test_it_publishes_at_its_rate_in_a_pause_too(wall):
    mode = RealTime(SimSettings(publish_rate=250.0), RosClock(is_active=True), wall)
    assert mode.tick_rate(is_paused=False) == mode.tick_rate(is_paused=True) == 250.0
    mode.change(SimSettings(publish_rate=100.0), 3)
    assert mode.tick_rate(is_paused=True) == 100.0


# Scaled --------------------------------------------------------------------------------------


@pytest.mark.parametrize('factor', [0.1, 1.0, 7.5, 100.0])
def test_steps_are_due_by_the_factor(wall, factor):
    mode, step = scaled(wall, factor), 0
    for _ in range(100):
        wall.now += 10 * MS
        step = mode.due(step, NEXT)
    assert step == pytest.approx(1000.0 * factor, abs=1.0)
    assert mode.lost == 0.0
    # The next one is due when it says, and not before.
    wall.now = mode.wakes(step + 1) - 1000
    assert mode.due(step, NEXT) == step
    wall.now += 2000
    assert mode.due(step, NEXT) == step + 1


def test_without_a_pace_all_is_due_and_it_wakes_soon(wall):
    mode = scaled(wall, 0.0)
    assert mode.due(3, NEXT) == sys.maxsize
    assert mode.wakes(1000) == wall.now + GAP
    assert mode.lost == 0.0


def test_another_factor_acts_from_now_on(wall):
    mode = scaled(wall, 1.0)
    wall.now += 100 * MS
    step = mode.due(0, NEXT)
    assert step == 100
    mode.change(SimSettings(time_mode='scaled', speed_factor=20.0), step)
    assert mode.due(step, NEXT) == step
    wall.now += 10 * MS
    assert mode.due(step, NEXT) == step + 200


def test_other_settings_do_not_delay_what_is_due(wall):
    mode = scaled(wall, 1.0)
    wall.now += 100 * MS
    mode.change(SimSettings(time_mode='scaled', publish_rate=100.0), 0)
    assert mode.due(0, NEXT) == 100


def test_periods_that_are_too_late_are_skipped_and_reported(wall):
    mode = scaled(wall, 2.0)
    wall.now += 3 * SECOND
    step = mode.due(0, NEXT)
    assert step == 2 * 1000 * CATCH_UP // SECOND
    assert mode.lost == pytest.approx(2.0 * 2.5)
    assert mode.due(step, NEXT) == step


def test_stamps_are_steps_and_never_go_back(wall):
    mode = scaled(wall, 1.0)
    assert mode.stamp(0) == mode.now() == FIRST
    assert mode.stamp(2000) == FIRST + 2 * SECOND
    mode.restart(2500)  # the next state is one period of 2 ms later
    assert mode.stamp(0) == FIRST + 2502 * MS
    assert mode.now() == FIRST + 2502 * MS


@pytest.mark.parametrize(
    ('given', 'rate'),
    [
        ({'speed_factor': 1.0, 'publish_rate': 50.0, 'clock_rate': 200.0}, 200.0),
        ({'speed_factor': 0.5, 'publish_rate': 50.0, 'clock_rate': 20.0}, 25.0),
        ({'speed_factor': 100.0}, 1000.0),
        ({'speed_factor': 0.0}, 1000.0),
    ],
)
def test_it_looks_as_often_as_messages_are_due(wall, given, rate):
    mode = Scaled(SimSettings(time_mode='scaled', **given), wall)
    assert mode.tick_rate(is_paused=False) == rate
    assert mode.tick_rate(is_paused=True) == 10.0


# Lockstep ------------------------------------------------------------------------------------


def test_a_period_is_due_when_all_muscles_were_commanded(wall):
    mode = lockstep(wall, muscles=2)
    mode.turns.take([0])
    wall.now += SETTLE
    assert mode.due(0, NEXT) == 0
    mode.turns.take([1])
    assert mode.due(0, NEXT) == NEXT
    assert (mode.speed, mode.wakes(NEXT)) == (0.0, None)
    assert mode.tick_rate(is_paused=False) == 10.0


@pytest.mark.parametrize('again', ['align', 'restart'])
def test_after_a_pause_and_a_reset_more_than_one_command_is_expected(wall, again):
    mode = lockstep(wall)
    mode.turns.take([0])
    wall.now += SETTLE
    mode.turns.begin()
    getattr(mode, again)(20)
    mode.turns.take([0])
    assert mode.due(0, NEXT) == 0
    wall.now += SETTLE
    assert mode.due(0, NEXT) == NEXT


# Choice --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ('name', 'kind', 'makes_time'),
    [('real_time', RealTime, False), ('scaled', Scaled, True), ('lockstep', Lockstep, True)],
)
def test_the_mode_is_that_of_the_settings(name, kind, makes_time):
    given = {'time_mode': name, 'muscles': ['a', 'b']}
    scene = Scene(given)
    setup = scene.build(checked(scene.table(), given))
    mode = mode_of(setup, frozenset, RosClock(is_active=False))
    assert type(mode) is kind
    assert mode.makes_time is makes_time is setup.settings.has_own_time
    assert (mode.turns is not None) is (name == 'lockstep')
