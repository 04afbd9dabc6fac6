# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How closely the law reaches and follows: truth plants with unconfigured effects, every joint."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.effects import (
    EFFECTS,
    CoulombFriction,
    Creep,
    DeadBand,
    DeadTime,
    EndStop,
    Hysteresis,
    Leak,
    LengthOffset,
    Payload,
    PeriodicDisturbance,
    PressureDependentDamping,
    PressureHysteresis,
    PressureLag,
    PressureOffset,
    Slack,
    Softening,
    Supply,
    ViscousFriction,
)
from pam_ros.rig import co_contraction
from support.assertions import no_error
from support.closed_loop import LAG, shared
from support.joint_loop import JOINTS, close_joint
from support.kinds import EACH_KIND, ONE, PAIR, at_end, rms
from support.marks import at_release
from support.pair_loop import close_pair, nominal
from truth.pair import TruthPair, pair_plant

pytestmark = pytest.mark.needs_numba

DEGREE = math.radians(1.0)
BY_JOINT = pytest.mark.parametrize('name', ['parallel', 'lever', 'crank'])
NOISES = {True: 0.02 * DEGREE, False: 20e-6}  # of an angle, of a position
AT_REST = {True: 0.03 * DEGREE, False: 30e-6}
QUIET = {'noise': 0.0}
ZONE = [replace(LAG[0], dead_zone=6e3)]
# Of each effect values that change a motion visibly.
IN_MUSCLES = (
    DeadTime(delay=0.0123),
    PressureOffset(offset=7e3, gain=0.03),
    DeadBand(band=2e4, width=4e3),
    PressureLag(fill=0.05, vent=0.08, fastest=2e6, fastest_vent=1e6, choking=0.4),
    Leak(rate=0.2, refill=0.15, supply=5e5, vent=0.02),
    LengthOffset(offset=0.012),
    Softening(limit=0.05, per_pressure=2e-7, per_second=0.02),
    Creep(force=0.04, stiffness=400.0, pressure=0.03, time=0.8, spread=3.0),
    Hysteresis(slip=6.0, slip_width=0.03, initial=0.1),
    PressureHysteresis(slip=4e3, slip_width=2e4, initial=0.1),
    Slack(share=1.0, toe=20.0, push=5.0),
    PressureDependentDamping(inflating=3e-4, deflating=6e-4),
    PeriodicDisturbance(force_sin=4.0, force_cos=-2.0, pressure_sin=800.0, frequency=3.3),
)
ON_JOINT = (
    Payload(mass=0.3),
    ViscousFriction(coefficient=0.05),
    CoulombFriction(level=0.15, breakaway=0.22, stribeck_speed=0.3),
    EndStop(upper=0.6, stiffness=400.0, lower=-0.6, lower_stiffness=300.0),
    Supply(share=0.2, level=3.5e5, recovery=1.0),
)
NAMES = [effect.name for effect in (*IN_MUSCLES, *ON_JOINT)]


@pytest.mark.slow
@pytest.mark.parametrize(
    ('kind', 'plant', 'effects', 'more', 'rate', 'error', 'swing'),
    [
        (ONE, 'nominal', (), {'seed': 7}, 500.0, 0.01, 3e3),
        (ONE, 'payload', (), {'seed': 7}, 500.0, 0.01, 3e3),
        (ONE, 'lag', LAG, {'seed': 7}, 500.0, 0.01, 3e3),
        (ONE, 'dead zone', ZONE, {'seed': 7}, 500.0, 0.01, 3e3),
        (ONE, 'hysteresis', (), {'seed': 7}, 500.0, 0.03, 3e3),
        (ONE, 'nominal', (), QUIET, 500.0, 0.06, 1e3),
        (ONE, 'lag', (), QUIET, 500.0, 0.06, 1e3),
        (ONE, 'all', (), QUIET, 500.0, 0.06, 1e3),
        (ONE, 'payload', (), {}, 200.0, 0.01, 3e3),
        (ONE, 'payload', (), {}, 1000.0, 0.01, 3e3),
        (PAIR, 'payload and friction', (), {}, 500.0, 0.01, 1e3),
    ],
    ids=str,
)
def test_a_step_is_reached_and_then_it_is_calm(kind, plant, effects, more, rate, error, swing):
    """Errors in mm or degrees, swings of the pressure in Pa, over the last 2 s."""
    law = SlidingMode(kind.nominal(effects))
    seconds = 12.0 if swing < 3e3 else 8.0  # a hunt begins late
    run = kind.close(law, kind.truth(plant, **more), kind.step, seconds, rate=rate)
    found = at_end(kind, run)
    assert found[0] < error
    assert found[1] < swing
    if plant == 'nominal':  # within 2 % of the step, a second after it
        assert np.all(np.abs(run.error[run.t > 2.0]) < 0.02 * 0.02)


@pytest.mark.slow
@pytest.mark.parametrize(
    ('kind', 'plant', 'effects', 'rate', 'most'),
    [
        (ONE, 'nominal', (), 500.0, 0.02),
        (ONE, 'payload', (), 500.0, 0.02),
        (ONE, 'lag', LAG, 500.0, 0.05),
        (ONE, 'dead zone', ZONE, 500.0, 0.05),
        (ONE, 'hysteresis', (), 500.0, 0.15),
        at_release(PAIR, 'nominal', (), 500.0, 0.2),
        at_release(PAIR, 'payload', (), 500.0, 0.2),
        at_release(PAIR, 'friction', (), 500.0, 0.2),
        (PAIR, 'payload and friction', (), 500.0, 0.2),
        (PAIR, 'quick lag', (), 500.0, 0.2),
        at_release(PAIR, 'lag', LAG, 500.0, 0.2),
        (PAIR, 'dead zone', ZONE, 500.0, 0.2),
        (PAIR, 'payload', (), 200.0, 0.2),
        at_release(PAIR, 'payload', (), 1000.0, 0.2),
    ],
    ids=str,
)
def test_a_sine_is_followed(kind, plant, effects, rate, most):
    law = SlidingMode(kind.nominal(effects))
    run = kind.close(law, kind.truth(plant, seed=7), kind.swing, 8.0, rate=rate)
    end = run.last(4.0)
    assert np.ptp((run.target - run.error)[end]) > 0.96 * np.ptp(run.target[end])
    assert rms(kind, run) < most


@EACH_KIND
def test_two_runs_are_the_same_to_the_bit(kind):
    runs = [
        kind.close(SlidingMode(kind.nominal()), kind.truth('friction', seed=2), kind.swing, 1.0)
        for _ in range(2)
    ]
    assert runs[0].pressure.tobytes() == runs[1].pressure.tobytes()


@pytest.mark.slow
@pytest.mark.parametrize('plant', ['nominal', 'payload', 'payload and friction', 'all'])
def test_the_stiffness_is_what_is_set_while_the_angle_holds(plant):
    law, goal = SlidingMode(nominal()), 10.0 * DEGREE

    def stiffness(t):
        return 18.0 if t < 4.0 else 36.0

    run = close_pair(law, pair_plant(plant, seed=3), lambda t: goal, 9.0, stiffness)
    # By differences of the pulls of the truth plant's muscles, and by the closed form.
    for t, wanted in ((3.9, 18.0), (8.9, 36.0)):
        n = np.searchsorted(run.t, t)
        assert run.stiffness[n] == pytest.approx(wanted, rel=1e-3)
        assert abs(run.error[n]) < 0.03 * DEGREE
    if plant == 'nominal':
        expected = co_contraction.co_contraction_pressures(nominal(), goal, 36.0)
        np.testing.assert_allclose(run.pressure[:, -1], expected, rtol=2e-3)
    assert np.max(np.abs(run.error[run.t > 3.0])) < 0.03 * DEGREE


def test_a_heavier_arm_that_begins_away_from_rest_is_caught():
    run = close_pair(
        SlidingMode(nominal()), TruthPair(mass=2.0, seed=1), lambda t: 0.4, 6.0, begin=0.4
    )
    assert np.max(np.abs(run.error)) < 3.0 * DEGREE
    assert np.max(np.abs(run.error[run.last(1.0)])) < 0.01 * DEGREE


def heavier(joint):
    """Return a joint with a load and friction that nobody configured."""
    friction = 0.05 if joint.is_revolute else 20.0
    unknown = [Payload(mass=0.2 * joint.load.mass), ViscousFriction(coefficient=friction)]
    return replace(joint, effects=unknown)


@BY_JOINT
def test_the_default_gains_suit_every_joint(name):
    joint = JOINTS[name]
    with no_error():
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


@pytest.mark.slow
def test_muscles_that_pull_in_the_same_direction_get_the_same_pressure():
    joint = JOINTS['four']
    run = close_joint(SlidingMode(joint), joint, lambda t: 0.3, 1.0, begin=0.0)
    np.testing.assert_array_equal(run.pressure[0], run.pressure[2])
    np.testing.assert_array_equal(run.pressure[1], run.pressure[3])
    assert np.min(np.abs(run.pressure[0] - run.pressure[1])[100:]) > 1e3


def test_each_effect_is_configured_below():
    assert {*NAMES} == {effect.name for effect in EFFECTS}


@pytest.mark.slow
@pytest.mark.parametrize('name', [*NAMES, 'all'])
def test_effects_that_are_configured_of_a_pair_give_a_law_that_runs(name):
    in_muscles, on_load = (
        [effect for effect in effects if name in ('all', effect.name)]
        for effects in (IN_MUSCLES, ON_JOINT)
    )
    joint = nominal(in_muscles, on_load)
    run = close_joint(SlidingMode(joint), joint, lambda t: 0.3 if t > 0.2 else 0.0, 2.5, begin=0.0)
    assert np.all(np.isfinite(run.pressure))
    most = 1.0 if name == 'all' else 0.5
    assert np.max(np.abs(run.error[run.last(0.5)])) < most * DEGREE
