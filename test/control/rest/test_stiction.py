# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A load that sticks and slips is pushed to its goal, and nothing else is."""

import numpy as np
import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.rest.stiction import Stiction, StictionTuning
from pam_ros.control.sliding_mode import SlidingMode
from support.kinds import EACH_KIND, ONE, PAIR, at_end
from support.marks import at_release
from truth.effects import effect
from truth.pair import FEEDBACK_NOISE, TruthPair
from truth.sensor import Sensor

DT = 2e-3
TUNING = StictionTuning()
TOLERANCE = 40e-6 / 3  # m; the load may be off by 1.5 of it
# 15 and 25 N at the ends of two muscles on a radius of 40 mm, N m.
STICKY = effect(
    'coulomb_friction', coulomb_n=1.2, static_n=2.0, stribeck_m_s=0.05, bristle_n_m=5000.0
)
HASTY = {
    ONE: Shape(max_acceleration=1.0, max_jerk=20.0),
    PAIR: Shape.revolute(max_acceleration=25.0, max_jerk=1000.0),
}


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


def hunt(block, stiction, seconds, gain):
    """Integrate the error like any law, until the pushes take over; return whether they did."""
    force, took_over = block.middle, False
    for _ in range(round(seconds / DT)):
        force -= gain * block.x * DT
        pushed = stiction.follow(DT, -block.x, force, 20.0)
        if pushed is not None:
            took_over, force = True, pushed
        block.pull(force, DT)
    return took_over, force


@pytest.mark.parametrize(
    ('x', 'speed', 'gain', 'within'),
    # Of slow slips, force and position are taken at the goal, where the load slides: a third of
    # what breaks it loose.
    [(-1e-3, 0.02, 60e3, 5.0), (-0.2e-3, 1e-3, 200e3, 25 / 3), (-0.2e-3, 2e-3, 200e3, 25 / 3)],
)
def test_pushes_end_a_hunt_at_the_goal_with_nothing_pulling(x, speed, gain, within):
    block, stiction = Block(x, speed=speed), Stiction(TOLERANCE, TUNING)
    assert (speed < TUNING.loose_speed) is (x > -1e-3)
    took_over, force = hunt(block, stiction, 40.0, gain)
    assert took_over
    assert abs(block.x) < 2.5 * 20e-6
    assert force == pytest.approx(block.middle, abs=within)


def test_a_load_that_follows_is_left_alone():
    stiction = Stiction(TOLERANCE, TUNING)
    x, force = -1e-3, 200.0
    for _ in range(5000):
        force -= 100.0 * x * DT
        x += DT * 0.5 * ((force - 200.0) / 7000.0 - x)
        assert stiction.follow(DT, -x, force, 1.0) is None


def test_lengths_and_forces_of_a_pair_are_those_along_its_muscles():
    of_one, of_pair = (SlidingMode(kind.nominal()) for kind in (ONE, PAIR))
    one, two = of_one._stiction._tuning, of_pair._stiction._tuning
    assert two.loose_displacement == pytest.approx(one.loose_displacement / 0.04)
    assert two.loose_speed == pytest.approx(one.loose_speed / 0.04)
    assert two.dwell == one.dwell
    doubts = [law._estimates.standstill._tuning.doubt for law in (of_one, of_pair)]
    assert doubts[1] == pytest.approx(doubts[0] * 0.08)


def watched(kind):
    """Return a law, and the list of what its compensation says at each step."""
    law, pushed = SlidingMode(kind.nominal()), []
    follow = law._stiction.follow
    law._stiction.follow = lambda *seen: pushed.append(follow(*seen)) or pushed[-1]
    return law, pushed


def stepped(kind, law, plant, seconds=12.0, **more):
    """Run a step of 20 mm, or of half a radian."""
    target = kind.step if kind is ONE else lambda t: 0.5 if t > 0.5 else 0.0
    return kind.close(law, plant, target, seconds, **more)


@pytest.mark.slow
@pytest.mark.needs_numba
@EACH_KIND
@pytest.mark.parametrize('seed', [0, at_release(1)])
def test_on_the_truth_plant_stick_and_slip_end_within_the_tolerance(kind, seed):
    def plant():
        if kind is ONE:
            return ONE.truth('friction', seed=seed)
        return TruthPair(at_pivot=(STICKY,), sensor=Sensor(noise=FEEDBACK_NOISE), seed=seed)

    law, pushed = watched(kind)
    error, swing = at_end(kind, stepped(kind, law, plant(), shape=HASTY[kind]))
    assert any(push is not None for push in pushed)
    assert error < 0.03
    assert swing < 3e3
    # Without it, and as a push would not be rejected, the load hunts on and on.
    joint = kind.nominal()
    law = SlidingMode(joint, Gains.for_joint(joint, rejection=False))
    law._stiction.follow = lambda *seen: None
    error, _ = at_end(kind, stepped(kind, law, plant(), shape=HASTY[kind]))
    assert error > 0.3


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize(
    ('kind', 'plant'),
    [
        *((ONE, name) for name in ('nominal', 'lag', 'hysteresis')),
        *((PAIR, name) for name in ('nominal', 'friction', 'lag', 'hysteresis')),
    ],
    ids=str,
)
def test_plants_that_do_not_stick_and_slip_are_never_pushed(kind, plant):
    law, pushed = watched(kind)
    stepped(kind, law, kind.truth(plant, seed=2), 5.0)
    assert len(pushed) > 500
    assert set(pushed) == {None}
