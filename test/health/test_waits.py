# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the log of a simulator has about commands that are missing, by simulated time."""

import pytest

from pam_ros.health import waits
from pam_ros.health.simulator import commands
from pam_ros.health.waits import Waits
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from pam_ros.simulator.plant import Plant

FIRST = ['waits for commands on /pressure_command: pressures do not change']
SECOND = [*FIRST, 'commands are received on /pressure_command']
STEPS = 1000  # a second


class Log:
    """A logger that keeps the lines of each level."""

    def __init__(self):
        self.infos, self.warnings = [], []
        self.info, self.warning = self.infos.append, self.warnings.append


class Rig:
    """A plant, looked at once a simulated second."""

    def __init__(self):
        scene = Scene({})
        self.plant = Plant(scene.build(checked(scene.table(), {})))
        self.log = Log()
        self.waits = Waits(self.log, self.plant, '/pressure_command')

    def advance(self, seconds, *, commands_at=()):
        end = self.plant.step + seconds * STEPS
        while self.plant.step < end:
            self.plant.advance(self.plant.step + STEPS // 10)
            if self.plant.step % STEPS in commands_at:
                self.plant.take([1e5], [0])
            if self.plant.step % STEPS == 0:
                self.look()

    def look(self):
        missing = commands(self.plant, 0).message if any(self.plant.has_timed_out) else ''
        self.waits.look_for_commands(missing)


@pytest.fixture
def rig():
    return Rig()


def test_a_first_command_that_comes_late_and_one_that_comes_at_once(rig):
    rig.advance(1, commands_at=(500,))
    rig.advance(1, commands_at=(500,))
    assert rig.log.infos == []
    late = Rig()
    late.advance(5)
    assert late.log.infos == FIRST
    late.advance(2, commands_at=(500,))
    assert late.log.infos == SECOND


def test_commands_that_stop_and_come_back(rig):
    rig.advance(2, commands_at=(500,))
    rig.advance(4)
    (warning,) = rig.log.warnings
    assert warning.endswith(': vented')
    rig.advance(1, commands_at=(0, 500))
    assert rig.log.infos == []
    rig.advance(1, commands_at=(0, 500))
    assert rig.log.infos == ['commands are received again']
    assert len(rig.log.warnings) == 1


def test_commands_slower_than_the_timeout_are_reported_once(rig):
    rig.advance(1, commands_at=(500,))
    for _ in range(10):
        rig.advance(1)
        rig.advance(1, commands_at=(100,))
    assert len(rig.log.warnings) == 1
    assert rig.log.infos == []


def test_in_lockstep_a_controller_that_is_missed_and_back(rig, monkeypatch):
    now = 0
    monkeypatch.setattr(waits, 'steady_ns', lambda: now)
    for missing in (
        '',
        'waits for a controller, 1.2 s so far',
        'waits for a controller, 2.2 s so far',
        '',
        '',
        '',
    ):
        now += 10**9
        rig.waits.look('', missing)
    assert rig.log.infos == [
        'waits for a controller, 1.2 s so far',
        'commands are received: simulated time passes',
    ]


def test_a_simulator_that_no_longer_follows_a_clock_does_not_say_that_one_is_received(monkeypatch):
    now = [0]
    monkeypatch.setattr(waits, 'steady_ns', lambda: now[0] * 10**9)
    rig = Rig()
    for clock in ('waits for /clock', 'waits for /clock', None, None, 'waits for /clock'):
        rig.waits.look(clock, '')
        now[0] += 2
    assert rig.log.infos == ['waits for /clock']
    rig.waits.look('waits for /clock', '')
    rig.waits.look('', '')
    received = '/clock is received: simulated time passes'
    assert rig.log.infos == ['waits for /clock', 'waits for /clock', received]


def test_commands_in_kpa_are_mentioned_once_and_a_ramp_is_not(rig):
    rig.advance(1, commands_at=(900,))  # a first command of 100 kPa
    rig.advance(3, commands_at=(500,))
    assert rig.log.warnings == []
    low = Rig()
    low.plant.take([450.0], [0])
    assert commands(low.plant, 0).message.startswith('commands reach 450 Pa only')
    low.advance(4)
    text = 'commands reach 450 Pa only, and p_max is 600000 Pa: they are in Pa, are these in kPa'
    assert [line for line in low.log.warnings if 'Pa only' in line] == [f'{text} or bar?']
    low.plant.take([300e3], [0])
    assert commands(low.plant, 0).message == 'commanded'
    low.advance(2)
    assert low.log.infos.count('commands are higher now') == 1
