# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator without ROS, in each time mode, on clocks that the test sets."""

from types import SimpleNamespace

import numpy as np
import pytest

from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from pam_ros.simulator.modes import FIRST, SLICE, Lockstep, RealTime, Scaled
from pam_ros.simulator.plant import Plant
from pam_ros.simulator.simulator import Simulator
from pam_ros.simulator.turns import SETTLE, Turns
from pam_ros.timing.pace import SECOND
from support.paper import moved
from support.steady import Steady

MS = SECOND // 1000
# 100 Hz are 10 steps a sample.
COMMON = {'publish_rate': 100.0, 'command_timeout': 0.0}
RELEASED = {'initial.at_rest': False, 'initial.position': 0.0, 'initial.pressure': 6e5}
LOST = {'initial.at_rest': False, 'initial.velocity': -100.0}  # no muscle holds that


def built(**given):
    given = {**COMMON, **{name.replace('__', '.'): value for name, value in given.items()}}
    scene = Scene(given)
    return scene.build(checked(scene.table(), given))


class RosClock:
    """The ROS time of another node's ``/clock``."""

    ros_time_is_active = True

    def __init__(self):
        self.ns = 100 * SECOND

    def now(self):
        return SimpleNamespace(nanoseconds=self.ns)


class Bench:
    """A simulator, its clocks, and what it published."""

    def __init__(self, time_mode, **given):
        self.setup = built(time_mode=time_mode, **given)
        self.wall, self.ros = Steady(), RosClock()
        self.clock, self.states, self.readings, self.faults = [], [], [], []
        settings, count = self.setup.settings, len(self.setup.muscles)
        mode = {
            'real_time': lambda: RealTime(settings, self.ros, self.wall),
            'scaled': lambda: Scaled(settings, self.wall),
            'lockstep': lambda: Lockstep(
                settings, Turns(count, lambda: frozenset([b'one']), self.wall), self.wall
            ),
        }[time_mode]()
        self.simulator = Simulator(Plant(self.setup), mode, self, self.wall, self.wall)
        self.simulator.start()

    def publish_clock(self, stamp):
        self.clock.append(stamp)

    def publish(self, stamp, reading):
        self.states.append(stamp)
        self.readings.append(reading)

    def report(self, fault):
        self.faults.append(fault)

    def passes(self, seconds, tick=0.005):
        """Let time pass, and tick every *tick* s."""
        for _ in range(round(seconds / tick)):
            self.wall.now += round(tick * SECOND)
            self.ros.ns += round(tick * SECOND)
            self.simulator.tick()

    def answers(self, pressure=6e5):
        """Command all muscles."""
        count = len(self.setup.muscles)
        return self.simulator.take([pressure] * count, range(count))

    @property
    def times(self):
        """Times in s of the states, from that of the first one on."""
        return [(stamp - self.states[0]) / SECOND for stamp in self.states]


def every(seconds, first, last):
    return pytest.approx(np.arange(round(first / seconds), round(last / seconds) + 1) * seconds)


# Real time -----------------------------------------------------------------------------------


def test_ros_time_is_followed_and_the_states_are_those_of_the_equations():
    bench = Bench('real_time', **RELEASED)
    origin = bench.ros.ns
    bench.passes(1.0)
    assert bench.states[0] == origin
    assert bench.times == every(0.01, 0.0, 1.0)
    assert bench.clock == []
    position = [reading.position[0] for reading in bench.readings]
    expected = moved(600e3, 0.0, 0.0, np.arange(101) * 0.01)[0]
    np.testing.assert_allclose(position, expected, atol=2e-9)
    assert bench.simulator.published == 101


@pytest.mark.parametrize('time_mode', ['real_time', 'scaled'])
@pytest.mark.parametrize(('late', 'acts_at'), [(0.2, 10), (0.8, 11)])
def test_a_command_acts_from_the_step_that_is_nearest_to_its_arrival(time_mode, late, acts_at):
    bench = Bench(time_mode)
    bench.passes(0.01)
    bench.wall.now += round(late * MS)
    bench.ros.ns += round(late * MS)
    bench.answers(3e5)
    assert bench.simulator.plant.step == acts_at


def test_in_a_pause_the_state_is_published_with_the_time_of_publication():
    bench = Bench('real_time', **RELEASED)
    bench.passes(0.1)
    bench.simulator.pause(True)
    count, step = len(bench.states), bench.simulator.plant.step
    bench.passes(0.05, tick=0.01)
    assert bench.simulator.plant.step == step
    assert bench.states[count:] == [bench.ros.ns - k * 10 * MS for k in (4, 3, 2, 1, 0)]
    assert len({reading.position[0] for reading in bench.readings[count:]}) == 1
    bench.simulator.pause(False)
    bench.passes(0.1)
    assert bench.simulator.plant.step == step + 100  # the pause was not caught up


def test_commands_from_before_the_end_of_an_interruption_are_ignored():
    bench = Bench('real_time')
    bench.passes(0.1)
    bench.answers(1e5)
    bench.wall.now += 10 * SECOND
    bench.ros.ns += 10 * SECOND
    bench.answers(3e5)
    bench.passes(0.1)
    assert bench.readings[-1].pressure[0] == 1e5
    bench.passes(0.5)
    bench.answers(3e5)
    bench.passes(0.1)
    assert bench.readings[-1].pressure[0] == 3e5


# Scaled --------------------------------------------------------------------------------------


def test_time_passes_by_the_factor_and_is_published():
    bench = Bench('scaled', speed_factor=5.0, clock_rate=50.0)
    bench.passes(0.2)
    assert bench.states[0] == bench.clock[0] == FIRST
    assert bench.times == every(0.01, 0.0, 1.0)
    assert [(stamp - FIRST) / SECOND for stamp in bench.clock] == every(0.02, 0.0, 1.0)


def test_without_a_pace_commands_are_handled_after_each_slice():
    bench = Bench('scaled', speed_factor=0.0)
    bench.wall.reading = SLICE // 2
    bench.simulator.tick()
    count = len(bench.states)
    assert 1 < count < 5
    bench.simulator.tick()
    assert len(bench.states) == 2 * count


def test_in_a_pause_the_same_reading_is_repeated_at_the_same_time():
    bench = Bench('scaled', sensor__force_noise=1.0, **RELEASED)
    bench.passes(0.1)
    bench.simulator.pause(True)
    count, stamp = len(bench.states), bench.states[-1]
    bench.passes(5.0, tick=0.1)
    assert bench.states[count:] == [stamp] * 50
    assert {reading.force[0] for reading in bench.readings[count:]} == {
        bench.readings[count - 1].force[0]
    }
    bench.simulator.pause(False)
    bench.passes(0.1)
    assert np.all(np.diff(bench.states) >= 0)
    assert bench.states[-1] == stamp + 100 * MS


def test_after_a_reset_time_goes_on_from_the_initial_state():
    bench = Bench('scaled', **RELEASED)
    bench.passes(0.2)
    first, last = bench.readings[0], bench.states[-1]
    count = len(bench.states)
    bench.simulator.reset()
    bench.passes(0.1)
    assert bench.states[count] == last + 10 * MS
    assert bench.readings[count].position == first.position
    assert bench.readings[-1].position != first.position


# Lockstep ------------------------------------------------------------------------------------


def test_each_command_simulates_one_period():
    bench = Bench('lockstep', **RELEASED)
    bench.passes(0.1, tick=0.1)
    assert bench.states == [FIRST, FIRST]  # again for the controller that was found
    bench.answers()
    assert bench.states == [FIRST, FIRST]  # there may be more commands of a new controller
    bench.passes(0.3, tick=0.1)
    for _ in range(30):
        bench.answers()
    assert bench.times[1:] == every(0.01, 0.0, 0.31)
    position = [reading.position[0] for reading in bench.readings[1:]]
    np.testing.assert_allclose(
        position, moved(600e3, 0.0, 0.0, np.arange(32) * 0.01)[0], atol=2e-9
    )


def test_the_time_of_a_state_that_waited_is_published_again_when_it_is_answered():
    bench = Bench('lockstep', clock_rate=100.0)
    bench.passes(0.1, tick=0.1)
    bench.answers()
    count = len(bench.clock)
    bench.passes(SETTLE / SECOND, tick=0.05)
    assert bench.clock[count:] == [FIRST, FIRST + 10 * MS]


def test_it_waits_for_all_muscles():
    bench = Bench('lockstep', muscles=['a', 'b'])
    bench.answers()
    bench.passes(0.3, tick=0.1)
    count = len(bench.states)
    bench.simulator.take([1e5], [1])
    bench.passes(5.0, tick=0.1)
    assert len(bench.states) == count
    bench.simulator.take([1e5], [0])
    assert len(bench.states) == count + 1


def test_a_command_in_a_pause_is_answered_after_it():
    bench = Bench('lockstep')
    bench.answers()
    bench.passes(0.3, tick=0.1)
    bench.simulator.pause(True)
    bench.answers()
    assert bench.simulator.plant.step == 10
    bench.simulator.pause(False)
    bench.passes(0.3, tick=0.1)
    assert bench.simulator.plant.step == 20


# Services ------------------------------------------------------------------------------------


@pytest.mark.parametrize('time_mode', ['real_time', 'scaled', 'lockstep'])
def test_a_step_simulates_the_periods_and_publishes_each(time_mode):
    bench = Bench(time_mode, step_periods=3, **RELEASED)
    refusal = bench.simulator.step(lambda: False)
    assert refusal == (False, 'simulated time is not paused: pause it first')
    bench.simulator.pause(True)
    count, step = len(bench.states), bench.simulator.plant.step
    done, text = bench.simulator.step(lambda: False)
    assert done
    assert text.startswith('simulated 3 periods, until ')
    assert len(bench.states) == count + 3
    assert bench.simulator.plant.step == step + 30
    if time_mode == 'real_time':  # each has the time of its publication
        assert bench.states[count:] == [bench.ros.ns] * 3


def test_a_step_that_is_stopped_says_what_was_simulated():
    bench = Bench('scaled', step_periods=100)
    bench.simulator.pause(True)
    asked = []

    def is_stopped():
        asked.append(None)
        return len(asked) > 4

    found = bench.simulator.step(is_stopped)
    assert found == (False, 'stop requested: simulated 4 of 100 periods')


@pytest.mark.parametrize('time_mode', ['real_time', 'scaled'])
def test_a_state_that_is_lost_is_reported_and_the_rig_reset_and_paused(time_mode):
    bench = Bench(time_mode, **LOST)
    bench.passes(1.0)
    assert bench.simulator.is_paused
    assert len(bench.faults) == 1
    assert bench.faults[0] == bench.simulator.fault
    assert bench.faults[0].startswith('the state is invalid 0.')
    assert 'pam is out of its reach' in bench.faults[0]
    assert bench.faults[0].endswith(': reset and paused')
    assert bench.simulator.plant.step == 0
    assert all(np.isfinite(reading.force[0]) for reading in bench.readings)
    bench.simulator.pause(False)
    assert bench.simulator.fault == ''


# Parameters ----------------------------------------------------------------------------------


def test_another_rate_counts_from_here_and_the_ticks_follow():
    bench = Bench('scaled', clock_rate=10.0)
    bench.passes(0.103, tick=0.001)
    count = len(bench.states)
    assert bench.simulator.ticker.rate == 100.0
    bench.simulator.change(built(time_mode='scaled', publish_rate=50.0, clock_rate=40.0))
    bench.passes(0.1, tick=0.001)
    assert bench.simulator.ticker.rate == 50.0
    assert [(stamp - FIRST) // MS for stamp in bench.states[count:]] == [123, 143, 163, 183, 203]
    assert [(stamp - FIRST) // MS for stamp in bench.clock] == [0, 100, 125, 150, 175, 200]


def test_a_bad_command_is_returned_and_the_last_valid_one_remains_active():
    bench = Bench('scaled')
    assert bench.answers(2e5) is None
    bad = bench.answers(float('nan'))
    assert bad.is_refused
    assert 'is not finite' in bad.reason
    bench.passes(0.1)
    assert bench.readings[-1].pressure[0] == 2e5
