# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What configured effects take, against the rig that has them: of one muscle, and of a pair."""

import math

import numpy as np
import pytest

from pam_ros.control.compensation import FeedForwardForces, left_to_feedback
from pam_ros.control.gains import Gains
from pam_ros.control.model import ControlModel
from pam_ros.control.signals import Reference
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.effects import CoulombFriction, Creep, Hysteresis, Leak, Payload
from pam_ros.rig.joint import Actuator
from pam_ros.rig.run import simulate_held
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support.pair_loop import nominal

DT = 2e-3
LOSSES = [Hysteresis(slip=30.0, slip_width=0.02), Creep(force=0.04)]
FRICTION = [CoulombFriction(level=0.3)]
HYSTERESIS = [Hysteresis(slip=20.0)]


def losses_of(joint):
    return FeedForwardForces(ControlModel(joint))


def test_losses_along_a_motion_are_what_the_rig_pulls_less():
    joint, bare = single_muscle_joint(effects=LOSSES), single_muscle_joint()
    t = np.arange(0.0, 4.0, DT)
    y = 0.05 + 0.02 * np.sin(2.0 * t) ** 2
    v = np.gradient(y, t)
    p = 300e3 + 50e3 * np.sin(3.0 * t)
    with_effects = simulate_held(joint, t, p, y, v, step=DT).force
    without = simulate_held(bare, t, p, y, v, step=DT).force
    losses = losses_of(joint)
    losses.start(y[0], p[:1])
    found = []
    for n in range(len(t)):
        reference = Reference(y[n], v[n])
        found.append(losses.follow(DT, reference, (p[n],)))
    expected = without - with_effects
    assert np.ptp(expected) > 40.0
    np.testing.assert_allclose(found[5:], expected[5:], atol=0.6)


@pytest.mark.parametrize('speed', [0.05, 1e-3])
@pytest.mark.parametrize('breakaway', [0.0, 25.0])
def test_friction_turns_over_with_the_motion_and_is_that_of_a_load_that_slides(breakaway, speed):
    friction = CoulombFriction(level=15.0, breakaway=breakaway, stribeck_speed=0.01)
    losses = losses_of(single_muscle_joint(effects=[friction]))
    losses.start(0.05, (300e3,))
    step = speed * DT
    for n in range(100):
        up = losses.follow(DT, Reference(0.05 + step * n, speed), (300e3,))
    for n in range(100):
        down = losses.follow(DT, Reference(0.05 + step * (100 - n), -speed), (300e3,))
    assert up == pytest.approx(15.0)
    assert down == pytest.approx(-15.0)
    assert losses.effort == down


@pytest.mark.parametrize('joint', [single_muscle_joint(), nominal()], ids=['one', 'pair'])
def test_without_effects_nothing_is_lost(joint):
    losses, pressures = losses_of(joint), (3e5,) * len(joint.muscles)
    losses.start(0.0, pressures)
    assert losses.follow(DT, Reference(0.05, 0.1), pressures) == 0.0


def test_it_lists_what_it_leaves_to_feedback():
    joint = single_muscle_joint(effects=[Payload(mass=1.0), Leak(rate=0.1), Hysteresis(slip=3.0)])
    assert left_to_feedback(joint) == ('leak',)


def test_an_effect_of_one_muscle_of_several_is_listed_too():
    plain, leaks = Actuator(contraction=0.1), Actuator(effects=[Leak(rate=0.1)])
    joint = nominal()
    assert left_to_feedback(joint) == ()
    assert left_to_feedback(type(joint)((plain, leaks), joint.load, joint.transmission)) == (
        'leak',
    )


# A pair ------------------------------------------------------------------------------------------


def sine(t):
    w, a = math.pi, 0.25
    return Reference(a * math.sin(w * t), a * w * math.cos(w * t), -a * w * w * math.sin(w * t))


def rms(believed, true, seconds=6.0):
    """Return the error of a law that takes a joint for another one, and learns nothing."""
    law, rig = SlidingMode(believed, Gains.revolute(learning=False)), Simulation([true])
    law.start(0.0)
    rig.reset(law.terms.pressures, [0.0], [0.0])
    errors = []
    for n in range(round(seconds / DT)):
        now = sine(n * DT)
        errors.append(now.position - rig.position[0])
        rig.command(law.update(DT, now, float(rig.position[0])))
        rig.advance(2)
    return float(np.sqrt(np.mean(np.square(errors[-1000:]))))


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize('which', ['friction', 'hysteresis'])
def test_what_is_configured_of_a_pair_is_compensated(which):
    true = nominal(load=FRICTION) if which == 'friction' else nominal(HYSTERESIS)
    known, unknown = rms(true, true), rms(nominal(), true)
    assert unknown > math.radians(0.05)
    assert known < 0.35 * unknown
