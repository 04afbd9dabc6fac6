# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How short a joint's steps must be: against falls stepped by hand, and random joints."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pam_ros.effects import PressureDependentDamping, ViscousFriction
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import statics
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.step_limit import check_step, longest_step
from pam_ros.rig.transmissions import Lever, Pulley, Straight
from support import joints, paper
from support.joint_models import BOTH_LONG, UNEQUAL, lever, pair, parallel

SOURCE = Muscle(a1=0.0, a2=0.0, a3=0.0, a4=0.0, a5=1.0, a6=0.0, pressure_unit='Pa', zeta=0.0)


def test_for_one_muscle_it_is_a_radian_of_the_stiffest_place_of_a_fall():
    """Let go at 25 % without pressure, by the paper's force and energy alone."""
    weight = 20.0 * paper.G
    y, v, h = 0.1, 0.0, 1e-4
    while v <= 0.0:  # an undamped fall until the muscle has stopped it
        v += h * (paper.force(0.0, 100.0 * y / paper.L0) - weight) / 20.0
        y += h * v
    stiffest = max(paper.stiffness(p, 100.0 * y / paper.L0) for p in (0.0, 6.0))
    expected = np.sqrt(20.0 / stiffest)
    free = longest_step(single_muscle_joint())
    assert free == pytest.approx(expected, rel=0.03)
    # A strongly damped rig creeps, but its fast root is 2 zeta times as fast: 9.9 at zeta 5.
    damped = longest_step(single_muscle_joint(Muscle(zeta=5.0)))
    assert damped == pytest.approx(free / (5.0 + np.sqrt(24.0)))
    assert longest_step(single_muscle_joint(SOURCE)) == np.inf


def of_pulley(p, angle):
    """Return torques by muscle, and the stiffness at 6 bar in both, of the pair."""
    y = joints.ends(angle, UNEQUAL)
    forces = [s.force(*each) for s, *each in zip(UNEQUAL, p, y, strict=True)]
    k = joints.R**2 * sum(s.stiffness(6.0, each) for s, each in zip(UNEQUAL, y, strict=True))
    return forces, (joints.R, -joints.R), k


def of_lever(p, angle):
    """Return the same of the lever: the stiffness with the most that the arms' change adds."""
    h, y = 1e-5, [k * s.l0 for k, s in zip((joints.KAPPA_1, joints.KAPPA_2), UNEQUAL, strict=True)]
    y = [at + joints.drawn(angle, i) for i, at in enumerate(y)]
    forces = [s.force(*each) for s, *each in zip(UNEQUAL, p, y, strict=True)]
    k = 0.0
    for i, (s, each) in enumerate(zip(UNEQUAL, y, strict=True)):
        turn = (joints.lever_arm(angle + h, i) - joints.lever_arm(angle - h, i)) / (2.0 * h)
        k += max(
            joints.lever_arm(angle, i) ** 2 * s.stiffness(bar, each) - turn * s.force(bar, each)
            for bar in (0.0, 6.0)
        )
    return forces, [joints.lever_arm(angle, i) for i in (0, 1)], k


def stiffest(kind, p, angle, pulls_only):
    """Let the joint go at an angle; return its greatest stiffness until it turns.

    Or until it is at a dead centre of the lever, beyond which no joint is meant to be.
    """
    rate, h, k = 0.0, 1e-4, 0.0
    forces, arms, _ = kind(p, angle)
    start = np.sign(np.dot(arms, forces) - joints.gravity(angle))
    while start * rate >= 0.0 and (kind is of_pulley or abs(angle) < joints.AT_0 - 0.1):
        forces, arms, most = kind(p, angle)
        if pulls_only:
            forces = [max(f, 0.0) for f in forces]
        tau = np.dot(arms, forces) - joints.gravity(angle)
        rate += h * tau / joints.J
        angle += h * rate
        k = max(k, most)
    return k


@pytest.mark.slow
@pytest.mark.parametrize(('made', 'kind'), [(pair, of_pulley), (lever, of_lever)])
def test_it_is_a_radian_of_the_stiffest_place_that_is_reached(made, kind):
    """Let go at either end of the travel, at any extreme of the pressures, with slack or not."""
    joint = made()
    k = max(
        stiffest(kind, (p1, p2), angle, pulls_only)
        for angle in statics.span(joint)
        for p1 in (0.0, 6.0)
        for p2 in (0.0, 6.0)
        for pulls_only in (False, True)
    )
    # A joint may also be let go where it has most energy, between the ends: no less than this.
    expected = np.sqrt(joints.J / k)
    assert longest_step(joint) <= 1.01 * expected
    assert longest_step(joint) > 0.7 * expected


def test_drag_shortens_the_step():
    """J s'' = -c s' - K s: the fast root is c/2J + sqrt((c/2J)^2 - K/J)."""
    free = longest_step(pair())
    decay = 0.5 * 30.0 / joints.J + joints.ZETA / free
    expected = decay + np.sqrt(decay**2 - 1.0 / free**2)
    slow = pair(load=[ViscousFriction(coefficient=30.0)])
    assert longest_step(slow) == pytest.approx(1.0 / expected)
    by_pressure = [PressureDependentDamping(inflating=0.08, deflating=0.01)]
    decay = 0.5 * 0.08 * 6e5 * joints.R**2 / joints.J + joints.ZETA / free
    expected = decay + np.sqrt(decay**2 - 1.0 / free**2)
    assert longest_step(pair(effects=(by_pressure, ()))) == pytest.approx(1.0 / expected)


def test_two_equal_muscles_need_the_step_of_one_with_half_the_mass():
    """Nearly: the energy of the fall is the same, the place that it is let go from is."""
    one = longest_step(single_muscle_joint(load=Mass(mass=15.0)))
    assert longest_step(parallel(30.0, BOTH_LONG)) == pytest.approx(one, rel=0.15)


@pytest.mark.parametrize(
    ('joint', 'step', 'sentence'),
    [
        (single_muscle_joint(), 0.0, 'a physics step of 0 s is not allowed: give more than 0'),
        (
            single_muscle_joint(),
            0.1,
            'a physics step of 100 ms does not resolve a mass of 20 kg on this muscle: give',
        ),
        (pair(), 0.0, 'a physics step of 0 s is not allowed: give more than 0'),
        (
            pair(),
            0.1,
            'a physics step of 100 ms does not resolve an inertia of 0.07 kg m^2 on these muscles',
        ),
        (
            lever(UNEQUAL[:1]),
            0.1,
            'a physics step of 100 ms does not resolve an inertia of 0.07 kg m^2 on this muscle:',
        ),
        (
            parallel(50.0),
            0.1,
            'a physics step of 100 ms does not resolve a mass of 50 kg on these muscles',
        ),
        (
            single_muscle_joint(load=Mass(mass=5e-324)),
            1e-3,
            'a physics step of 1 ms does not resolve a mass of 4.94066e-324 kg on this muscle: '
            'give more mass',
        ),
    ],
)
def test_a_step_that_resolves_nothing_is_refused(joint, step, sentence):
    with pytest.raises(ParameterError) as error:
        check_step(joint, step)
    assert str(error.value).startswith(sentence)


commands = st.lists(
    st.tuples(st.floats(0.0, 6e5), st.floats(0.0, 6e5), st.integers(1, 300)),
    min_size=1,
    max_size=5,
)


@pytest.mark.slow
@settings(deadline=None, max_examples=100)
@given(
    st.floats(0.01, 0.1),
    st.floats(1e-3, 1.0),
    st.floats(0.0, 5.0),
    st.floats(0.0, 0.5),
    st.floats(-3.0, 3.0),
    st.floats(0.05, 0.2),
    st.floats(0.1, 2.0),
    commands,
)
def test_no_pair_that_is_accepted_gives_nan(
    radius, inertia, mass, arm, hanging_at, contraction, zeta, commanded
):
    drive(Arm(inertia, mass, arm, hanging_at), Pulley(radius), contraction, zeta, commanded)


@pytest.mark.slow
@settings(deadline=None, max_examples=100)
@given(
    st.floats(0.01, 0.08),
    st.floats(0.1, 1.0),
    st.floats(1.0, 2.2),
    st.floats(1e-3, 1.0),
    st.floats(0.0, 5.0),
    st.floats(-3.0, 3.0),
    st.floats(0.1, 2.0),
    commands,
)
def test_nor_does_a_lever(crank, anchor, angle, inertia, mass, hanging_at, zeta, commanded):
    """It may be driven near a dead centre, where its arm is nearly nothing."""
    drive(Arm(inertia, mass, 0.2, hanging_at), Lever(crank, anchor, angle), 0.1, zeta, commanded)


@settings(deadline=None, max_examples=50)
@given(st.floats(0.05, 200.0), st.floats(0.1, 2.0), commands)
def test_nor_does_a_mass_on_two_muscles(mass, zeta, commanded):
    drive(Mass(mass=mass), Straight(), 0.0, zeta, commanded)


def drive(load, transmission, contraction, zeta, commanded):
    try:
        actuator = Actuator(Muscle(zeta=zeta), (), contraction)
        joint = Joint((actuator, actuator), load, transmission)
    except ParameterError:
        return
    rig = Simulation([joint], longest_step(joint))
    for *p, steps in commanded:
        rig.command(p)
        rig.advance(steps)
        assert np.all(np.isfinite(rig.position))
        assert np.all(np.isfinite(rig.muscle_outputs()))
        assert np.all(np.abs(rig.contraction) < 1.0)
