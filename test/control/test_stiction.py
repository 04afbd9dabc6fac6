# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A load that sticks and slips is pushed to its goal, and nothing else is."""

import numpy as np
import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.shaping import Shape
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.control.stiction import Stiction, StictionTuning
from support.closed_loop import close_loop, declared, step_target, truth

DT = 2e-3
TUNING = StictionTuning()
TOLERANCE = 40e-6 / 3  # m; the load may be off by 1.5 of it


class Block:
    """A load on dry friction that is pulled by a force: it sticks, breaks loose and slides on.

    It breaks loose *breaks* N from the middle force, then slides *way* m for each second that the
    force stays outside, as a load with little damping does.
    """

    def __init__(self, x, middle=200.0, breaks=25.0, speed=0.02):
        self.x, self.middle, self.breaks, self.speed = x, middle, breaks, speed
        self.slides = 0.0

    def pull(self, force, dt):
        up = force - self.middle
        if abs(up) > self.breaks:
            self.slides = np.copysign(self.speed, up)
        elif abs(up) < 0.6 * self.breaks:
            self.slides = 0.0
        self.x += self.slides * dt


def hunt(block, stiction, seconds):
    """Integrate the error like any law, until the pushes take over; return whether they did."""
    force, took_over = block.middle, False
    for _ in range(round(seconds / DT)):
        force -= 60e3 * block.x * DT
        pushed = stiction.follow(DT, -block.x, force, 20.0)
        if pushed is not None:
            took_over, force = True, pushed
        block.pull(force, DT)
    return took_over, force


def test_pushes_end_a_hunt_at_the_goal_with_nothing_pulling():
    block, stiction = Block(x=-1e-3), Stiction(TOLERANCE, TUNING)
    took_over, force = hunt(block, stiction, 40.0)
    assert took_over
    assert abs(block.x) < 2.5 * 20e-6
    assert force == pytest.approx(block.middle, abs=5.0)


def test_a_load_that_follows_is_left_alone():
    stiction = Stiction(TOLERANCE, TUNING)
    x, force = -1e-3, 200.0
    for _ in range(5000):
        force -= 100.0 * x * DT
        x += DT * 0.5 * ((force - 200.0) / 7000.0 - x)
        assert stiction.follow(DT, -x, force, 1.0) is None


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize('seed', [0, 1])
def test_on_the_truth_plant_stick_and_slip_end_within_the_tolerance(seed):
    law = SlidingMode(declared(), Gains())
    hasty = Shape(max_acceleration=1.0, max_jerk=20.0)
    run = close_loop(law, truth('friction', seed=seed), step_target(0.02), 12.0, shape=hasty)
    end = run.last(2.0)
    assert np.max(np.abs(run.error[end])) < 30e-6
    assert np.ptp(run.pressure[end]) < 3e3


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize('plant', ['nominal', 'lag', 'hysteresis'])
def test_plants_without_stiction_are_never_pushed(plant):
    law = SlidingMode(declared(), Gains())
    pushed = []
    follow = law._stiction.follow
    law._stiction.follow = lambda *seen: pushed.append(follow(*seen)) or pushed[-1]
    close_loop(law, truth(plant), step_target(0.02), 4.0)
    assert len(pushed) > 500
    assert set(pushed) == {None}
