# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What pushes move a load that is held: truth plants, every joint, unconfigured delays."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.effects import PeriodicDisturbance
from support.closed_loop import LAG, close_loop, nominal, truth
from support.joint_loop import JOINTS, close_joint
from support.marks import at_release
from support.pair_loop import close_pair
from support.pair_loop import nominal as nominal_pair
from truth.effects import effect
from truth.pair import TruthPair, pair_plant
from truth.sensor import Sensor

pytestmark = [pytest.mark.needs_numba, pytest.mark.slow]

BEGIN, SECONDS = 1.0, 9.0  # s


def sine(size, frequency, end=math.inf):
    """Return a push that begins at BEGIN."""
    return lambda t: (
        size * math.sin(2 * math.pi * frequency * (t - BEGIN)) if BEGIN <= t < end else 0.0
    )


def swing(run, seconds=2.0):
    """Return half of what the load moves in the last *seconds*."""
    return 0.5 * float(np.ptp(run.error[run.last(seconds)]))


def held(plant, push, effects=(), **gains):
    law = SlidingMode(nominal(effects=effects), Gains(**gains))
    return close_loop(law, plant, lambda t: 0.0, SECONDS, push=push)


def left_alone(plant, push):
    """Return half of what the load moves in the last 2 s at a constant pressure."""
    dt, pressure = 2e-3, plant.state.u
    y = []
    for n in range(round(SECONDS / dt)):
        plant.step(pressure, dt, push(n * dt))
        y.append(plant.y)
    return 0.5 * float(np.ptp(y[-1000:]))


# The ratios of docs/controller_disturbances.md, less what noise adds to half of a range.
@pytest.mark.parametrize(('frequency', 'least'), [(0.5, 13.0), (1.0, 9.0), (2.0, 7.0), (3.0, 8.0)])
@pytest.mark.parametrize('lag', [(), LAG], ids=['nominal', 'configured lag'])
def test_a_push_moves_the_load_many_times_less_than_at_a_held_pressure(frequency, least, lag):
    push, name = sine(8.0, frequency), 'lag' if lag else 'nominal'
    run = held(truth(name, seed=5), push, effects=lag)
    ratio = left_alone(truth(name, seed=5), push) / swing(run)
    assert ratio > (0.67 * least if lag else least)


# The natural frequencies of these loads, from 2.4 to 4 Hz, are below and above that of the force.
@pytest.mark.parametrize(('mass', 'p0'), [(27.0, 231e3), (25.0, 330e3), (16.0, 320e3)])
def test_a_force_that_begins_before_a_motion_is_rejected_after_it(mass, p0):
    """While the reference moves, it looks like an oscillation of the loop."""
    push = sine(8.0, 3.0)

    def back_and_forth(t):
        return 0.01 if 2.0 <= t < 5.0 else 0.0

    law = SlidingMode(nominal(mass=mass))
    plant = truth('nominal', mass=mass, p0=p0, seed=7)
    run = close_loop(law, plant, back_and_forth, 14.0, push=push)
    alone = left_alone(truth('nominal', mass=mass, p0=p0), push)
    assert swing(run, 4.0) < alone / 4.0
    assert law.terms.feedback > 0.9


@pytest.mark.parametrize('frequency', [4.0, 6.0, 10.0, 15.0, 20.0])
def test_no_quick_push_is_made_much_larger(frequency):
    push = sine(8.0, frequency)
    noise = swing(held(truth('nominal', seed=5), lambda t: 0.0))
    moved = swing(held(truth('nominal', seed=5), push)) - noise
    assert moved < 1.6 * left_alone(truth('nominal', seed=5), push)


def test_without_rejection_the_same_push_moves_it_far():
    run = held(truth('nominal'), sine(8.0, 2.0), rejection=False)
    assert swing(run) > 5.0 * swing(held(truth('nominal'), sine(8.0, 2.0)))


@pytest.mark.parametrize('name', ['nominal', 'payload', 'hysteresis'])
def test_a_constant_push_is_taken_up_and_let_go(name):
    run = held(truth(name, seed=4), lambda t: 50.0 if BEGIN <= t < 3.0 else 0.0)
    late = 0.5 if name == 'nominal' else 1.2
    for at in (BEGIN, 3.0):
        after = (run.t > at + late) & (run.t < at + 2.0)
        assert np.max(np.abs(run.error[after])) < 1e-4
    assert np.max(np.abs(run.error[run.last(2.0)])) < 3e-5


def test_a_load_that_is_taken_off_is_caught():
    plant = truth('payload', seed=4)

    def push(t):
        if t >= BEGIN:
            plant.parameters.payload_kg = 0.0
        return 0.0

    run = held(plant, push)
    assert np.max(np.abs(run.error[run.t > BEGIN + 0.8])) < 1e-4


DELAYS = {
    'lag 20/28 ms': (effect('pressure_lag', 'two_times', fill_s=0.020, vent_s=0.028),),
    'lag 50/70 ms': (effect('pressure_lag', 'two_times', fill_s=0.050, vent_s=0.070),),
    'dead time 20 ms': (effect('dead_time', dead_time_s=0.020),),
}


@pytest.mark.parametrize('name', DELAYS)
@pytest.mark.parametrize('size', [8.0, 50.0])
def test_an_unconfigured_delay_reduces_the_rejection_without_oscillation(name, size):
    push = sine(size, 1.0, 5.0)
    run = held(truth(DELAYS[name], seed=6), push)
    pushed = (run.t > 2.0) & (run.t < 5.0)
    alone = left_alone(truth(DELAYS[name]), sine(size, 1.0))
    assert np.max(np.abs(run.error[pushed])) < alone
    # When the push has ended the load comes to rest.
    assert np.max(np.abs(run.error[run.last(1.0)])) < 0.02 * alone + 2e-5
    assert np.min(run.terms['highest_rejection']) < 1.0


def test_the_level_is_0_where_nothing_pushes_and_while_the_reference_moves():
    run = held(truth('nominal', seed=3), lambda t: 0.0)
    assert np.mean(run.terms['rejection'] > 0.0) < 0.01
    law = SlidingMode(nominal())
    run = close_loop(law, truth('nominal'), lambda t: 0.01 * math.sin(math.pi * t), 4.0)
    assert not np.any(run.terms['rejection'][run.t > 0.1])


def test_a_torque_on_a_pair_is_rejected():
    push, degree = sine(0.6, 1.0), math.radians(1.0)
    law = SlidingMode(nominal_pair())
    run = close_pair(law, pair_plant('nominal', seed=2), lambda t: 0.0, SECONDS, push=push)
    law = SlidingMode(nominal_pair())
    law.start(0.0)
    plant = TruthPair(sensor=Sensor(noise=0.0))
    plant.reset(0.0, law.terms.pressures)
    alone = []
    for n in range(4500):
        plant.step(law.terms.pressures, 2e-3, push(n * 2e-3))
        alone.append(plant.angle)
    assert np.ptp(alone[-1000:]) > 1.6 * degree
    assert swing(run) < 0.1 * 0.5 * np.ptp(alone[-1000:])


@pytest.mark.parametrize(
    'name',
    [at_release(name) if name == 'four' else name for name in JOINTS],
)
def test_a_force_in_one_muscle_of_any_joint_is_rejected(name):
    joint = JOINTS[name]
    shaken = replace(
        joint.actuators[0], effects=[PeriodicDisturbance(force_sin=8.0, frequency=2.0)]
    )
    rig = replace(joint, actuators=(shaken, *joint.actuators[1:]))
    noise = math.radians(0.02) if joint.is_revolute else 20e-6
    found = {}
    for is_on in (True, False):
        law = SlidingMode(joint, Gains.for_joint(joint, rejection=is_on))
        goal = 0.5 * sum(law.allocation.reach)
        run = close_joint(law, rig, lambda t, goal=goal: goal, 8.0, noise=noise)
        found[is_on] = swing(run)
    assert found[True] < 0.4 * found[False]
