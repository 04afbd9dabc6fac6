# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A pair that sticks and slips at its pivot is pushed to its goal, and none other is."""

import math

import numpy as np
import pytest

from pam_ros.control.shaping import Shape
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.rig.joint import one_muscle
from support.pair_loop import close_pair, declared
from truth.effects import effect
from truth.pair import FEEDBACK_NOISE, TruthPair, pair_plant
from truth.sensor import Sensor

pytestmark = pytest.mark.needs_numba

DEGREE = math.radians(1.0)
# 15 and 25 N at the ends of two muscles on a radius of 40 mm, N m.
STICKY = effect(
    'coulomb_friction', coulomb_n=1.2, static_n=2.0, stribeck_m_s=0.05, bristle_n_m=5000.0
)
HASTY = Shape.turning(max_acceleration=25.0, max_jerk=1000.0)


def goal(t):
    return 0.5 if t > 0.5 else 0.0


def watched():
    """Return a law, and the list of what its compensation says at each step."""
    law, pushed = SlidingMode(declared()), []
    follow = law._stiction.follow
    law._stiction.follow = lambda *seen: pushed.append(follow(*seen)) or pushed[-1]
    return law, pushed


def without_pushes():
    law = SlidingMode(declared())
    law._stiction.follow = lambda *seen: None
    return law


@pytest.mark.slow
@pytest.mark.parametrize('seed', [0, 1])
def test_stick_and_slip_at_the_pivot_end_within_the_tolerance(seed):
    def plant():
        return TruthPair(at_pivot=(STICKY,), sensor=Sensor(noise=FEEDBACK_NOISE), seed=seed)

    law, pushed = watched()
    run = close_pair(law, plant(), goal, 12.0, shape=HASTY)
    end = run.last(2.0)
    assert any(push is not None for push in pushed)
    assert np.max(np.abs(run.error[end])) < 0.03 * DEGREE
    assert np.max(np.ptp(run.pressure[:, end], axis=1)) < 3e3
    # Without it the arm hunts on and on.
    run = close_pair(without_pushes(), plant(), goal, 12.0, shape=HASTY)
    assert np.max(np.abs(run.error[end])) > 0.3 * DEGREE


@pytest.mark.slow
@pytest.mark.parametrize('plant', ['nominal', 'friction', 'lag', 'hysteresis'])
def test_pairs_that_do_not_stick_and_slip_are_never_pushed(plant):
    law, pushed = watched()
    close_pair(law, pair_plant(plant, seed=2), goal, 5.0)
    assert len(pushed) > 500
    assert set(pushed) == {None}


def test_its_lengths_and_forces_are_those_along_the_muscles():
    of_one, of_pair = SlidingMode(one_muscle()), SlidingMode(declared())
    one, two = of_one._stiction._tuning, of_pair._stiction._tuning
    assert two.loose_way == pytest.approx(one.loose_way / 0.04)
    assert two.loose_speed == pytest.approx(one.loose_speed / 0.04)
    assert two.dwell == one.dwell
    doubts = of_one._standstill._tuning.doubt, of_pair._standstill._tuning.doubt
    assert doubts[1] == pytest.approx(doubts[0] * 0.08)
