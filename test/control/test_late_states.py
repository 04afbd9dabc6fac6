# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""States that stay away or come late: control goes on by the model until the time-out."""

import numpy as np
import pytest

from pam_ros.control.loop import RUNNING, VENT, Loop, Measurement
from pam_ros.control.pid import Pid
from pam_ros.control.plausibility import Plausibility, bounds_of
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.reference.source import ReferenceSource
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.health.reports import Reports
from pam_ros.settings.control import ControlSettings
from pam_ros.timing.delay import Lateness
from pam_ros.timing.pace import SECOND
from support.closed_loop import close_loop, nominal, sine_target, truth
from support.marks import at_release

PERIOD, RATE = 0.002, 500.0
LATE = 8.0  # s at which states stay away
DELAY = 0.4  # s for which they do: below the default of state_timeout


class Late:
    """A plant whose sensor is not read from LATE on for *delay* s."""

    def __init__(self, plant, delay):
        self.plant, self.delay, self.time = plant, delay, 0.0

    def __getattr__(self, name):
        return getattr(self.plant, name)

    def step(self, pressure, dt, push=0.0):
        measured = self.plant.step(pressure, dt, push)
        self.time += dt
        return None if LATE < self.time < LATE + self.delay else measured


def largest_error(law, name, target, delay):
    """Return the largest error in mm from LATE until 1 s after the states are back."""
    run = close_loop(law(nominal()), Late(truth(name, seed=3), delay), target, 10.0, RATE)
    then = (run.t > LATE) & (run.t < LATE + delay + 1.0)
    return 1e3 * np.max(np.abs(run.error[then]))


@pytest.mark.parametrize(('law', 'most'), [(SlidingMode, 0.1), (Pid, 1.0)])
@pytest.mark.parametrize('plant', ['nominal', 'friction', 'lag'])
def test_a_load_that_is_held_stays_where_it_is(law, most, plant):
    assert largest_error(law, plant, lambda t: 0.0, DELAY) < most


@pytest.mark.parametrize(('law', 'most'), [(SlidingMode, 0.2), (Pid, 4.0)])
def test_a_moving_reference_is_followed_by_the_model(law, most):
    """The reference moves by up to 13 mm meanwhile."""
    assert largest_error(law, 'nominal', sine_target(0.01, 0.5), DELAY) < most


def loop_of(law, plant):
    settings, law = ControlSettings(), law(nominal())
    loop = Loop(
        law,
        ReferenceSource(Shape(), (-0.02, 0.1)),
        PERIOD,
        Plausibility(bounds_of(law.allocation)),
    )
    loop.timeout, loop.safe = settings.state_timeout, settings.on_timeout
    assert loop.safe == VENT
    loop.chambers = (plant.state.u,)
    return loop


@pytest.mark.parametrize('law', [SlidingMode, Pid])
def test_the_loop_neither_vents_nor_restarts(law):
    plant = truth('nominal', seed=3)
    loop = loop_of(law, plant)
    measured, positions, commands = plant.measure(), [], []
    for n in range(round((LATE + 1.0) / PERIOD)):
        t = n * PERIOD
        if not LATE < t < LATE + DELAY:
            loop.see(Measurement(t, measured, stamp=t))
        (pressure,) = loop.tick(t)
        measured = plant.step(pressure, PERIOD)
        positions.append(plant.y)
        commands.append(pressure)
    assert loop.state == RUNNING
    assert loop.starts == 1
    late = slice(round(LATE / PERIOD), None)
    assert np.ptp(positions[late]) < 1e-3
    assert np.max(np.abs(np.diff(commands[late]))) < 5e3


STALLS, STALL = 1.0, 0.12  # 1/s, and s that one lasts in the mean
CATCH_UP = 5  # times as fast as time passes a rig catches up
MOVES = 2.0  # s between two targets


class Busy:
    """A rig on a busy computer: it stops for some time, again and again, and catches up.

    Its states have the stamps of the times at which they would have been measured.
    """

    def __init__(self, plant, seed):
        self.plant, self.random = plant, np.random.default_rng(seed)
        self.count, self.stops_until = 0, 0.0
        self.speeds = []

    def run_until(self, periods, command):
        """Follow *command* Pa up to the period *periods*, if it can; return the states."""
        now = periods * PERIOD
        if now > 2.0 and now >= self.stops_until and self.random.random() < STALLS * PERIOD:
            self.stops_until = now + min(self.random.exponential(STALL), DELAY)
        states = []
        while now >= self.stops_until and self.count < periods and len(states) < CATCH_UP:
            before = self.plant.y
            measured = self.plant.step(command, PERIOD)
            self.count += 1
            self.speeds.append(abs(self.plant.y - before) / PERIOD)
            states.append((self.count * PERIOD, measured))
        return states


BUSY = [
    (plant, *move)
    for plant in ('nominal', 'friction', 'lag')
    for move in (*((0.01, seed, 1.2) for seed in range(4)), (-0.04, 0, 1.5))
]
OFTEN = [('friction', 0.01, 0, 1.2), ('lag', -0.04, 0, 1.5)]  # the others before a release


@pytest.mark.parametrize(
    ('plant', 'distance', 'seed', 'most'),
    [one if one in OFTEN else at_release(*one) for one in BUSY],
)
def test_the_load_is_moved_within_its_limits_by_a_rig_on_a_busy_computer(
    plant, distance, seed, most
):
    """If late states count as present ones, it is thrown at up to 1.4 m/s (10 mm, 12 seeds).

    If the reference goes on while the rig has stopped, it is moved by 10 mm at up to 0.19 m/s, and
    by 40 mm with this seed at 0.25 to 0.41 m/s.
    """
    rig = Busy(truth(plant, seed=seed), seed)
    loop = loop_of(SlidingMode, rig.plant)
    lateness, reports, low = Lateness(), Reports(None), rig.plant.y
    loop.see(Measurement(0.0, rig.plant.measure(), stamp=0.0))
    (command,) = loop.tick(0.0)
    for n in range(1, round(20.0 / PERIOD)):
        now = n * PERIOD
        for stamp, measured in rig.run_until(n, command):
            late = lateness.of(round(stamp * SECOND), round(now * SECOND)) / SECOND
            reports.delay(late)
            loop.see(Measurement(now - late, measured, stamp=stamp, late=late))
        (command,) = loop.tick(now)
        if n % round(MOVES / PERIOD) == 0:
            loop.source.set_target(low + distance * (now // MOVES % 2))
    late_states = reports.received(0.0, '').late
    assert late_states > 50
    assert loop.starts == 1
    print(f'{max(rig.speeds):.3f} m/s, {late_states} late')
    assert max(rig.speeds) < most * Shape().max_velocity
