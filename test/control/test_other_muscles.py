# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The law with a muscle that is not the configured one, over the whole reach."""

import numpy as np
import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.sliding_mode import SlidingMode
from support.closed_loop import close_loop, nominal, sine_target, truth
from support.marks import at_release
from support.other_muscles import BraidedMuscle, over_the_reach

pytestmark = pytest.mark.needs_numba


def without_learning(joint):
    return SlidingMode(joint, Gains(learning=False))


@pytest.mark.slow
@pytest.mark.parametrize(
    'muscle', ['random', at_release('dmsp_20_datasheet'), at_release('braided')]
)
def test_learning_makes_a_large_sine_more_accurate(muscle):
    _, learned = over_the_reach(SlidingMode, muscle, 7)
    _, plain = over_the_reach(without_learning, muscle, 7)
    assert learned < 0.5 * plain
    assert learned < (0.7 if muscle == 'braided' else 0.15)


@pytest.mark.slow
def test_steps_from_near_the_rest_length_become_no_worse_by_learning():
    """There the nominal muscle is four times as stiff as this one; rate and steps of a user.

    With one slope for the whole reach, learning made the overshoot five times as large.
    """
    overshoots = []
    for seed in range(3):
        rig = BraidedMuscle(seed)
        start = rig.y

        def target(t, start=start):
            return (0.05 if int(t / 2.5 + 1e-9) % 2 else -0.004) - start

        law = SlidingMode(nominal())
        run = close_loop(law, rig, target, 25.0, rate=200.0)
        for n in range(3, 10, 2):
            arrived = (run.t > 2.5 * n + 1.0) & (run.t < 2.5 * (n + 1) - 1e-6)
            overshoots.append(-1e3 * np.min(run.error[arrived]))
    assert np.mean(overshoots) < 2.5
    # The force law at the lowest position differs by more than the friction of the rig.
    assert law.learned.weight > 0.8


class Sprung:
    """The nominal muscle of the truth plant, with a spring of 3 N/mm beside it."""

    STIFFNESS = 3000.0  # N/m

    def __init__(self):
        self._plant = truth('nominal')
        self._origin, self.state = self._plant.y, self._plant.state

    @property
    def y(self):
        return self._plant.y

    def measure(self):
        return self._plant.measure()

    def step(self, command, dt, push=0.0):
        force = -self.STIFFNESS * (self.y - self._origin)
        return self._plant.step(command, dt, push + force)


def test_the_stiffness_of_a_spring_is_learned():
    law = SlidingMode(nominal())
    run = close_loop(law, Sprung(), sine_target(0.015, 0.5), 8.0)
    assert law.learned.stiffness == pytest.approx(Sprung.STIFFNESS, rel=0.1)
    assert 1e3 * np.sqrt(np.mean(run.error[run.last(2.0)] ** 2)) < 0.05
