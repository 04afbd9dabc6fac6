# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""States that come late: control goes on by the model until the time-out."""

import numpy as np
import pytest

from pam_ros.control.loop import RUNNING, VENT, Loop, Reading
from pam_ros.control.plausibility import Plausibility, bounds_of
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.reference.source import ReferenceSource
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.settings.control import ControlSettings
from support.baseline import pid
from support.closed_loop import close_loop, nominal, sine_target, truth

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


@pytest.mark.parametrize(('law', 'most'), [(SlidingMode, 0.1), pid(1.0)])
@pytest.mark.parametrize('plant', ['nominal', 'friction', 'lag'])
def test_a_load_that_is_held_stays_where_it_is(law, most, plant):
    assert largest_error(law, plant, lambda t: 0.0, DELAY) < most


@pytest.mark.parametrize(('law', 'most'), [(SlidingMode, 0.2), pid(4.0)])
def test_a_moving_reference_is_followed_by_the_model(law, most):
    """The reference moves by up to 13 mm meanwhile."""
    assert largest_error(law, 'nominal', sine_target(0.01, 0.5), DELAY) < most


@pytest.mark.parametrize('law', [SlidingMode, pid()])
def test_the_loop_neither_vents_nor_restarts(law):
    settings, plant = ControlSettings(), truth('nominal', seed=3)
    law = law(nominal())
    loop = Loop(
        law,
        ReferenceSource(Shape(), (-0.02, 0.1)),
        PERIOD,
        Plausibility(bounds_of(law.allocation)),
    )
    loop.timeout, loop.safe = settings.state_timeout, settings.on_timeout
    assert loop.safe == VENT
    loop.chambers = (plant.state.u,)
    measured, positions, commands = plant.measure(), [], []
    for n in range(round((LATE + 1.0) / PERIOD)):
        t = n * PERIOD
        if not LATE < t < LATE + DELAY:
            loop.see(Reading(t, measured, stamp=t))
        (pressure,) = loop.tick(t)
        measured = plant.step(pressure, PERIOD)
        positions.append(plant.y)
        commands.append(pressure)
    assert loop.state == RUNNING
    assert loop.starts == 1
    late = slice(round(LATE / PERIOD), None)
    assert np.ptp(positions[late]) < 1e-3
    assert np.max(np.abs(np.diff(commands[late]))) < 5e3
