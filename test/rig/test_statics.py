# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints at rest against roots, differences and searches over equations of their own."""

import re

import numpy as np
import pytest
from scipy.optimize import brentq

from pam_ros.errors import ParameterError, RangeError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import statics
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Mass
from pam_ros.rig.run import simulate, simulate_held
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support import joints, paper
from support.joint_models import BOTH_LONG, UNEQUAL, lever, pair, parallel

PRESSURES = [(0.0, 0.0), (4.0, 3.0), (6.0, 1.0), (1.0, 6.0), (6.0, 6.0)]
BAR = 1e5


def net(angle, p, strands=UNEQUAL):
    return joints.torque(p, angle, strands) - joints.gravity(angle)


@pytest.mark.parametrize('strands', [BOTH_LONG, UNEQUAL])
@pytest.mark.parametrize('p', PRESSURES)
def test_a_pair_rests_where_torques_balance(strands, p):
    root = brentq(net, -2.0, 2.0, (p, strands), xtol=1e-14)
    assert statics.equilibrium(pair(strands), BAR * np.array(p)) == pytest.approx(root, abs=1e-12)


def test_it_comes_to_rest_there():
    rig = Simulation([pair()])
    rig.command([4e5, 2e5])
    rig.advance(8000)
    assert rig.position[0] == pytest.approx(brentq(net, -2.0, 2.0, ((4.0, 2.0),)), abs=1e-9)
    assert equilibrium(rig.joints[0], [4e5, 2e5]) == pytest.approx(rig.position[0], abs=1e-9)
    np.testing.assert_allclose(rig.joint_outputs().effort[0], joints.gravity(rig.position[0]))


def test_two_muscles_hold_the_weight_together():
    joint = parallel(50.0, offsets=(0.02, -0.01))
    one, two = UNEQUAL

    def left(s, p, q):
        return one.force(p, 0.008 + s) + two.force(q, -0.002 + s) - 50.0 * paper.G

    for p, q in PRESSURES:
        root = brentq(left, -0.05, 0.2, (p, q), xtol=1e-15)
        assert equilibrium(joint, [p * BAR, q * BAR]) == pytest.approx(root, abs=1e-12)


@pytest.mark.parametrize('strands', [UNEQUAL, UNEQUAL[:1]], ids=['two', 'one'])
@pytest.mark.parametrize('p', PRESSURES[:4])
def test_a_lever_rests_where_torques_balance(strands, p):
    p = p[: len(strands)]
    joint = lever(strands)

    def left(angle):
        return joints.lever_torque(p, angle, strands) - joints.gravity(angle)

    root = brentq(left, -1.5, 1.4, xtol=1e-14)
    assert statics.equilibrium(joint, BAR * np.array(p)) == pytest.approx(root, abs=1e-12)


@pytest.mark.parametrize('strands', [UNEQUAL, UNEQUAL[:1]], ids=['two', 'one'])
@pytest.mark.parametrize('angle', [-0.5, 0.0, 0.7])
def test_a_levers_stiffness_is_a_difference_of_efforts(angle, strands):
    """The arm changes with the angle: what each muscle pulls is a part of the stiffness."""
    p, h = (4.0, 3.0)[: len(strands)], 1e-5
    joint, pascal = lever(strands), [BAR * one for one in p]
    tau = joints.lever_torque(p, angle, strands)
    assert statics.effort(joint, pascal, angle) == pytest.approx(tau, rel=1e-12)
    one, other = (joints.lever_torque(p, angle + way, strands) for way in (h, -h))
    found = statics.stiffness(joint, pascal, angle)
    assert found == pytest.approx((other - one) / (2.0 * h), rel=1e-7)
    by_muscles_alone, revolute = 0.0, 0.0
    for i, (strand, pressure) in enumerate(zip(strands, p, strict=True)):
        y = (joints.KAPPA_1, joints.KAPPA_2)[i] * strand.l0 + joints.drawn(angle, i)
        by_muscles_alone += joints.lever_arm(angle, i) ** 2 * strand.stiffness(pressure, y)
        slope = joints.lever_arm(angle + h, i) - joints.lever_arm(angle - h, i)
        revolute += slope / (2.0 * h) * strand.force(pressure, y)
    assert found == pytest.approx(by_muscles_alone - revolute, rel=1e-6)
    assert abs(revolute) > 1e-3 * by_muscles_alone


@pytest.mark.parametrize('angle', [-0.5, 0.0, 0.7])
def test_effort_stiffness_and_weight_are_those_of_the_equations(angle):
    p, h = (4.0, 3.0), 1e-5
    joint, pascal = pair(), (4e5, 3e5)
    assert statics.effort(joint, pascal, angle) == pytest.approx(joints.torque(p, angle, UNEQUAL))
    assert statics.weight(joint, angle) == pytest.approx(joints.gravity(angle), rel=1e-12)
    y, total = joints.ends(angle, UNEQUAL), 0.0
    for strand, pressure, each in zip(UNEQUAL, p, y, strict=True):
        total += joints.R**2 * strand.stiffness(pressure, each)
    assert statics.stiffness(joint, pascal, angle) == pytest.approx(total, rel=1e-12)
    # What returns the joint to its equilibrium: both stiffnesses.
    slope = (net(angle + h, p) - net(angle - h, p)) / (2.0 * h)
    whole = statics.stiffness(joint, pascal, angle) + statics.weight_stiffness(joint, angle)
    assert whole == pytest.approx(-slope, rel=1e-6)


def test_angles_may_be_arrays():
    angles = np.linspace(-0.5, 0.5, 7)
    for joint in (pair(), lever()):
        for function in (statics.effort, statics.stiffness, statics.pull):
            found = function(joint, (4e5, 3e5), angles)
            np.testing.assert_allclose(found, [function(joint, (4e5, 3e5), a) for a in angles])
        for function in (statics.position, statics.contraction, statics.arm_slope):
            found = function(joint, 1, angles) + np.zeros(7)
            np.testing.assert_allclose(found, [function(joint, 1, a) for a in angles])
        assert statics.weight(joint, angles).shape == angles.shape


def test_pressures_are_one_a_muscle_or_one_for_all():
    joint = pair()
    assert statics.each(joint, 2e5) == [2e5, 2e5]
    assert statics.each(joint, [2e5, 3e5]) == [2e5, 3e5]
    with pytest.raises(ValueError, match='broadcast'):
        statics.each(joint, [1.0, 2.0, 3.0])


def test_a_joint_without_an_equilibrium_reports_the_remaining_force():
    class Heavy:
        """A mechanism that is not checked as a joint is: a thousand times the weight."""

        def __init__(self, joint):
            self.muscles, self.at_zero = joint.muscles, joint.at_zero
            self.transmission, self.load = joint.transmission, joint.load
            self.moved_mass, self.inertia = 1000.0 * joint.moved_mass, 1000.0 * joint.inertia

    with pytest.raises(RangeError, match=r'no equilibrium: with 0 and 0 kPa the resulting effort'):
        statics.equilibrium(Heavy(parallel(50.0)), 0.0)


def test_only_one_muscle_on_a_mass_has_its_coordinate_from_its_length():
    assert statics.is_direct(single_muscle_joint())
    moved = Joint((Actuator(Muscle(), (), 0.1),), Mass())
    assert not any(map(statics.is_direct, (pair(), lever(), parallel(50.0), moved)))
    # It rests as far up as the other does, counted from where it is mounted.
    shift = equilibrium(single_muscle_joint(), 3e5) - equilibrium(moved, 3e5)
    assert shift == pytest.approx(0.1 * 0.4, abs=1e-12)


def test_a_muscles_push_counts_as_none_in_the_pull():
    joint = pair()
    y1, y2 = joints.ends(0.6, UNEQUAL)
    forces = UNEQUAL[0].force(0.0, y1), UNEQUAL[1].force(3.0, y2)
    assert forces[0] < 0.0 < forces[1]
    assert statics.pull(joint, (0.0, 3e5), 0.6) == pytest.approx(-joints.R * forces[1])


def test_a_load_that_stands_on_soft_muscles_falls_to_either_side():
    """Upside down, without pressure, the upright is unstable: the rest is near it."""
    heavy = {'mass': 6.0, 'hanging_at': np.pi, 'contraction_1': 0.1, 'contraction_2': 0.1}
    joint = pair(BOTH_LONG, **heavy)
    assert statics.stiffness(joint, 0.0, 0.0) + statics.weight_stiffness(joint, 0.0) < 0.0
    angle = equilibrium(joint, 0.0)
    assert abs(angle) > 0.1
    assert statics.effort(joint, 0.0, angle) == pytest.approx(statics.weight(joint, angle))
    assert statics.stiffness(joint, 0.0, angle) + statics.weight_stiffness(joint, angle) > 0.0
    assert equilibrium(joint, 6e5) == pytest.approx(0.0, abs=1e-12)  # filled, it stands


def test_the_span_is_where_both_muscles_have_permissible_lengths():
    """From -4 to 25 %: the first muscle limits one end, the second the other."""
    low, high = statics.span(pair())
    kappa = np.array([joints.ends(a, UNEQUAL) for a in (low, high)]) / [s.l0 for s in UNEQUAL]
    assert np.all(kappa > -0.04 - 1e-12)
    assert np.all(kappa < 0.25 + 1e-12)
    assert kappa[0, 1] == pytest.approx(0.25)
    assert kappa[1, 1] == pytest.approx(-0.04)
    assert statics.span(parallel(50.0, BOTH_LONG), 0.1, 0.9) == pytest.approx((-0.056, 0.38))


# Where a simulation may start --------------------------------------------------------------------


@pytest.mark.parametrize(
    ('joint', 'position', 'sentence'),
    [
        (
            single_muscle_joint(),
            64.0,
            '64 m is not possible with a muscle of 0.4 m: give -0.08 to',
        ),
        (single_muscle_joint(), -0.09, '-0.09 m is not possible with a muscle of 0.4 m'),
        (pair(), 45.0, '45 rad is not possible with this joint: give -'),
        (lever(), 20.0, '20 rad is not possible with this joint: give -'),
    ],
)
def test_a_position_that_the_muscles_cannot_have_is_no_start(joint, position, sentence):
    low, high = statics.position_range(joint)
    simulation, t = Simulation([joint]), np.linspace(0.0, 0.1, 11)
    pressures = np.full((1, len(joint.muscles)), 2e5)
    starts = (
        lambda s: simulation.reset(2e5, s, 0.0),
        lambda s: simulate(joint, t, pressures, [0.0], position=s),
        lambda s: simulate_held(joint, t, np.repeat(pressures, t.size, 0), np.full(t.size, s)),
    )
    for start in starts:
        with pytest.raises(ParameterError, match=f'^position = {re.escape(sentence)}'):
            start(position)
        for end in (low, high):
            start(end)


def test_a_load_without_a_spring_may_start_anywhere():
    source = Muscle(a1=0.0, a2=0.0, a3=0.0, a4=0.0, a5=1.0, a6=0.0, pressure_unit='Pa', zeta=0.0)
    rail = Simulation([single_muscle_joint(source, Mass(mass=2.0, mount='horizontal'))])
    rail.reset(0.0, 64.0, 0.0)
    assert rail.position == 64.0
