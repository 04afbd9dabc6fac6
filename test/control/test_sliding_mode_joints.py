# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The same law on joints of every kind: parallel, lever, crank; and with every declared effect."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.limits import Limits
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.effects import EFFECTS
from recorded.cases import MUSCLE_EFFECTS, TURNED_EFFECTS
from support.closed_loop import shared
from support.joint_loop import JOINTS, close_joint
from support.pair_loop import declared

pytestmark = pytest.mark.needs_numba

DEGREE = math.radians(1.0)
BY_JOINT = pytest.mark.parametrize('name', ['parallel', 'lever', 'crank'])
NOISES = {True: 0.02 * DEGREE, False: 20e-6}  # of an angle, of a position
AT_REST = {True: 0.03 * DEGREE, False: 30e-6}


def heavier(joint):
    """Return a joint with a load and friction that nobody declared."""
    friction = 0.05 if joint.is_revolute else 20.0
    unknown = {
        'payload': {'mass': 0.2 * joint.load.mass},
        'viscous_friction': {'coefficient': friction},
    }
    return replace(joint, effects=unknown)


@BY_JOINT
def test_the_default_gains_suit_every_joint(name):
    joint = JOINTS[name]
    Gains.for_joint(joint).check(shared(joint), 2e-3)


@pytest.mark.slow
@BY_JOINT
@pytest.mark.parametrize('share', [0.2, 0.8])
def test_the_law_brings_every_joint_to_a_position_within_its_reach(name, share):
    joint = JOINTS[name]
    low, high = shared(joint).reach
    middle, goal = 0.5 * (low + high), low + share * (high - low)
    noise = NOISES[joint.is_revolute]
    run = close_joint(
        SlidingMode(joint), heavier(joint), lambda t: goal if t > 1.0 else middle, 7.0, noise=noise
    )
    end = run.last(1.5)
    assert np.max(np.abs(run.error[end])) < AT_REST[joint.is_revolute]
    assert np.max(np.ptp(run.pressure[:, end], axis=1)) < 3e3
    # It does not go far beyond its goal.
    way = abs(goal - middle)
    assert np.max(np.abs(run.coordinate - middle)) < 1.05 * way


@pytest.mark.slow
@BY_JOINT
def test_every_joint_follows_a_swing(name):
    joint = JOINTS[name]
    low, high = shared(joint).reach
    middle, swing = 0.5 * (low + high), 0.1 * (high - low)

    def target(t):
        return middle + swing * math.sin(math.pi * round(t, 2))

    run = close_joint(SlidingMode(joint), heavier(joint), target, 8.0)
    assert np.sqrt(np.mean(run.error[run.last(4.0)] ** 2)) < 0.02 * swing


@BY_JOINT
def test_commands_of_every_joint_stay_within_their_limits(name):
    joint, limits = JOINTS[name], Limits(50e3, 450e3, 2e6)
    law = SlidingMode(joint, limits=limits)
    low, high = law.sharing.reach
    goals = (low - 0.5 * (high - low), high + 0.5 * (high - low))
    run = close_joint(law, heavier(joint), lambda t: goals[int(t) % 2], 4.0)
    assert np.all((run.pressure >= 50e3) & (run.pressure <= 450e3))
    assert np.max(np.abs(np.diff(run.pressure))) <= 2e6 * 2e-3 + 1e-6


@pytest.mark.slow
def test_muscles_that_pull_the_same_way_get_the_same_pressure():
    joint = JOINTS['four']
    run = close_joint(SlidingMode(joint), joint, lambda t: 0.3, 1.0, begin=0.0)
    np.testing.assert_array_equal(run.pressure[0], run.pressure[2])
    np.testing.assert_array_equal(run.pressure[1], run.pressure[3])
    assert np.min(np.abs(run.pressure[0] - run.pressure[1])[100:]) > 1e3


def test_each_effect_is_declared_below():
    assert {*MUSCLE_EFFECTS, *TURNED_EFFECTS} == {effect.name for effect in EFFECTS}


@pytest.mark.slow
@pytest.mark.parametrize('name', [*MUSCLE_EFFECTS, *TURNED_EFFECTS])
def test_every_effect_that_is_declared_of_a_pair_gives_a_law_that_runs(name):
    if name in MUSCLE_EFFECTS:
        joint = declared(effects={name: MUSCLE_EFFECTS[name]})
    else:
        joint = declared(load={name: TURNED_EFFECTS[name]})
    run = close_joint(SlidingMode(joint), joint, lambda t: 0.3 if t > 0.2 else 0.0, 3.0, begin=0.0)
    assert np.all(np.isfinite(run.pressure))
    assert np.max(np.abs(run.error[run.last(0.5)])) < 0.5 * DEGREE


def test_all_effects_at_once_give_a_law_that_runs():
    joint = declared(effects=MUSCLE_EFFECTS, load=TURNED_EFFECTS)
    run = close_joint(SlidingMode(joint), joint, lambda t: 0.3 if t > 0.2 else 0.0, 4.0, begin=0.0)
    assert np.all(np.isfinite(run.pressure))
    assert np.max(np.abs(run.error[run.last(0.5)])) < 1.0 * DEGREE
