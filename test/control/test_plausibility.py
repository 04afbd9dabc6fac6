# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which measurements are taken for true: all of real motions, and none that cannot be."""

import math

import numpy as np
import pytest

from pam_ros.control.allocation import allocation_of
from pam_ros.control.limits import Limits
from pam_ros.control.loop import BLIND, RUNNING, Loop, Measurement
from pam_ros.control.model import ControlModel
from pam_ros.control.pid import Pid
from pam_ros.control.plausibility import MotionBounds, Plausibility, bounds_of, fault_of_pressure
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.reference.source import ReferenceSource
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support import closed_loop
from support.joint_loop import JOINTS
from support.joint_models import pair
from truth import Sensor, TruthPlant
from truth.effects import effect

DT = 2e-3
METRES = MotionBounds(-0.05, 0.15, 100.0, 1e-3, 'm')
JOINT = closed_loop.nominal()


def bounds_for(joint):
    return bounds_of(allocation_of(ControlModel(joint), Limits()))


# Bounds ------------------------------------------------------------------------------------------


def test_one_muscle_goes_as_fast_as_its_greatest_force_less_its_weight_twice():
    """The printed force law at the ends of pressure and length, with half the load."""
    muscle = Muscle()
    joint = single_muscle_joint(muscle, Mass(mass=20.0))
    found = bounds_for(joint)
    pull = float(muscle.force(muscle.p_max, muscle.kappa_min))
    assert found.acceleration == pytest.approx(2.0 * (pull / 20.0 + 9.80665), rel=1e-3)
    assert (found.low, found.high) == pytest.approx(
        ((muscle.kappa_min - 0.1) * muscle.l0, (muscle.kappa_max + 0.1) * muscle.l0)
    )


@pytest.mark.parametrize('joint', [pair(), *JOINTS.values()], ids=['pair', *JOINTS])
def test_every_joint_has_bounds_around_its_reach(joint):
    found, reach = bounds_for(joint), allocation_of(ControlModel(joint), Limits()).reach
    assert found.low < reach[0] < reach[1] < found.high
    assert 0.0 < found.allowance < 0.01 * (found.high - found.low)
    # From rest at its softest, all pressure at once moves no joint faster.
    rig = Simulation([joint])
    for pressures in ((0.0, 600e3), (600e3, 0.0)):
        drive = [pressures[i % 2] for i in range(len(joint.muscles))]
        middle = 0.5 * (reach[0] + reach[1])
        rig.reset(drive, [middle], [0.0])
        rig.advance(1)
        assert abs(rig.velocity[0]) / rig.step < found.acceleration


# One measurement after the other -----------------------------------------------------------------


def test_what_is_beyond_the_travel_is_never_true():
    gate = Plausibility(METRES)
    for false in (-0.0501, 0.151, -1.0, 1e300, -math.inf, math.nan):
        fault = gate.fault_of(0.002, false)
        assert 'beyond the travel of the joint, -0.05 to 0.15 m' in fault
    assert gate.fault_of(0.002, 0.15) == ''


def test_a_jump_is_true_as_far_as_the_joint_can_have_moved():
    """Closed form: 100 m/s^2 from rest over 20 ms are 20 mm, and 1 mm is allowed at any time."""
    gate = Plausibility(METRES)
    gate.fault_of(0.02, 0.05)
    gate.fault_of(0.02, 0.05)
    fault = gate.fault_of(0.02, 0.0711)
    assert fault == (
        'position 0.0711 m, which is 0.0211 m from the one 0.02 s before, but the joint can '
        'have moved 0.021 m at most'
    )
    assert gate.fault_of(0.02, 0.0709) == ''
    # It may stop at once, or go on at 1.045 m/s.
    assert gate.fault_of(0.02, 0.0709) == ''


def test_a_speed_is_allowed_to_last_and_then_is_forgotten():
    moving, resting = Plausibility(METRES), Plausibility(METRES)
    for n in range(20):
        moving.fault_of(0.002, 0.05 + 1e-3 * n)
        resting.fault_of(0.002, 0.05 + 1e-3 * n)
    for _ in range(200):
        resting.fault_of(0.002, 0.069)
    assert moving.fault_of(0.002, 0.074) == ''
    assert 'can have moved' in resting.fault_of(0.002, 0.074)


def test_of_the_first_two_that_do_not_fit_either_may_be_false():
    gate = Plausibility(METRES)
    assert gate.is_first
    assert gate.fault_of(0.0, 0.01) == ''
    assert gate.fault_of(0.002, 0.05) == ''
    assert gate.is_first
    assert gate.fault_of(0.002, 0.05) == ''
    assert not gate.is_first
    assert gate.fault_of(0.002, 0.01)
    gate.forget()
    assert gate.is_first
    assert gate.fault_of(0.002, 0.01) == ''


def test_a_measured_velocity_is_held_against_what_can_have_been_reached():
    gate = Plausibility(METRES)
    gate.fault_of(0.002, 0.05, 0.0)
    gate.fault_of(0.002, 0.05, 0.0)
    assert gate.fault_of(0.002, 0.05, 1.3) == (
        'velocity 1.3 m/s, but the joint can have reached 1.2 m/s at most'
    )
    assert 'velocity nan' in gate.fault_of(0.002, 0.05, math.nan)
    assert gate.fault_of(0.002, 0.05, -1.1) == ''


def test_the_velocity_of_the_first_measurement_counts_too():
    gate = Plausibility(METRES)
    assert gate.fault_of(0.0, 0.05, 1e300)
    assert gate.is_first
    assert gate.fault_of(0.0, 0.05, 1.0) == ''


ASKS = ' (is it in kPa?)'


@pytest.mark.parametrize(
    ('absolute', 'ambient', 'low', 'fault'),
    [
        *((true, 100e3, 0.0, '') for true in (80e3, 100e3, 850e3)),
        *(
            (false, 100e3, 0.0, '80000')
            for false in (79e3, 851e3, -50e3, math.nan, math.inf, 3.46)
        ),
        *((false, 100e3, 0.0, '80000' + ASKS) for false in (346.0, 100.0)),
        # A muscle that permits a vacuum may have one.
        (30e3, 100e3, -60e3, ''),
        (19e3, 100e3, -60e3, '20000'),
        # Sensors of gauge pressure have noise.
        (-100.0, 0.0, 0.0, ''),
    ],
)
def test_no_chamber_holds_much_less_or_much_more_than_is_permitted(absolute, ambient, low, fault):
    found = fault_of_pressure(absolute, ambient, (low, 600e3))
    least, asks, _ = fault.partition(ASKS)
    sentence = f'{absolute:.6g} Pa, but only {least} to 850000 Pa absolute is possible{asks}'
    assert found == (sentence if fault else '')


# Real motions ------------------------------------------------------------------------------------


@pytest.mark.parametrize('rate', [50.0, 200.0, 500.0, 1000.0])
@pytest.mark.parametrize('mass', [10.0, 30.0])
def test_every_measurement_of_the_hardest_motion_is_taken(rate, mass):
    """Pressure from end to end, half and more than the mass, a stop, noise, stamps that jitter."""
    random = np.random.default_rng([int(rate), int(mass)])
    stop = (effect('end_stop', stop_m=0.08),)
    plant = TruthPlant(effects=stop, mass=mass, p0=300e3, sensor=Sensor(noise=50e-6), seed=3)
    gate = Plausibility(bounds_for(JOINT))
    left_out, drive, last = [], 300e3, 0.0
    positions = []
    for n in range(1, int(20 * rate)):
        if random.random() < 4.0 / rate:
            drive = random.choice([0.0, 600e3])
        position = plant.step(drive, 1.0 / rate)
        positions.append(position)
        stamp = n / rate + random.uniform(-0.3e-3, 0.3e-3)
        fault = gate.fault_of(stamp - last, position)
        if fault:
            left_out.append((n, fault))
        else:
            last = stamp
    assert np.ptp(positions) > 0.06
    assert not left_out


# In the loop -------------------------------------------------------------------------------------


def loop_of(law):
    reach = law.allocation.reach
    return Loop(law, ReferenceSource(Shape(), reach), DT, Plausibility(bounds_of(law.allocation)))


def motion(law, false, at, *, is_moving=False, seconds=2.0):
    """Return positions of a load near 60 mm, and the loop, which hears a *false* one *at* s."""
    loop, plant = loop_of(law(JOINT)), closed_loop.truth('nominal', p0=300e3)
    loop.chambers = (300e3,)
    measured, found = plant.measure(), []
    for n in range(round(seconds / DT)):
        now = 10.0 + n * DT
        is_false = any(abs(n * DT - one) < 0.5 * DT for one in at)
        loop.see(Measurement(now, false if is_false else measured))
        (pressure,) = loop.tick(now)
        loop.chambers = None
        if n == 0:
            loop.source.set_target(0.06)
        elif is_moving:
            loop.source.set_target(0.06 + 0.01 * math.sin(2.0 * math.pi * 0.5 * n * DT))
        measured = plant.step(pressure, DT)
        found.append(plant.y)
    return np.array(found), loop


# m; the load is between 50 and 70 mm.
FALSE = [-1.0, -0.3, -0.06, -0.02, 0.0, 0.02, 0.05, 0.058, 0.0595, 0.0605, 0.062, 0.07, 0.1, 0.13]
FALSE += [0.15, 0.3, 1.0, 1e300]


@pytest.mark.parametrize(
    ('law', 'at', 'is_moving'),
    [
        (SlidingMode, (1.4,), False),
        (SlidingMode, (1.4, 1.402, 1.404), True),
        (Pid, (1.4,), True),
    ],
)
def test_false_positions_do_not_move_the_load(law, at, is_moving):
    true, _ = motion(law, 0.0, at=(), is_moving=is_moving)
    for false in FALSE:
        found, loop = motion(law, false, at, is_moving=is_moving)
        assert np.max(np.abs(found - true)) < 0.5e-3, false
        assert loop.state == RUNNING
        if abs(false - 0.06) > 0.015:
            assert loop.implausible == len(at)


def test_a_position_that_stays_false_ends_as_where_nothing_is_seen():
    at = np.arange(1.4, 1.6, DT)
    _, loop = motion(SlidingMode, -0.3, at, seconds=1.55)
    assert loop.state == BLIND
    assert loop.implausible == round(0.15 / DT)
    # When states return, control starts where the load is, at the pressure that it held.
    found, loop = motion(SlidingMode, -0.3, at, seconds=2.5)
    assert (loop.state, loop.starts) == (RUNNING, 2)
    assert np.max(np.abs(found[700:] - found[700])) < 0.5e-3


def test_control_that_started_at_a_false_position_restarts_at_the_true_one():
    found, loop = motion(SlidingMode, 0.02, at=(0.0,))
    assert (loop.state, loop.starts, loop.implausible) == (RUNNING, 2, 0)
    assert np.ptp(found) < 0.5e-3  # it holds the load where it is


def test_messages_that_were_held_up_are_true_by_their_own_stamps():
    """Thirty states of a load at 1 m/s that arrive at once, after 60 ms without any."""
    loop = loop_of(SlidingMode(JOINT))
    for n in range(60):
        now = 10.0 + DT * (n if n < 20 else 50)
        assert loop.see(Measurement(now + 1e-6 * n, DT * n - 0.03, None, 5.0 + DT * n)) == ''
