# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints in motion, against scipy's DOP853 on equations of their own and against conservation."""

import numpy as np
import pytest
from scipy.integrate import quad

from pam_ros.rig.joint import one_muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.rest import rest
from pam_ros.rig.rig import Rig
from support import joints, smooth_supply
from support.joint_models import BOTH_LONG, UNEQUAL, lever, muscle, pair, parallel
from support.joint_runs import BAR, MASS, OFFSETS, run, solve

# On an arm, 4 nrad are a tenth of a nanometre at the muscles' ends; with half the step, 0.3 nrad.
STEPS = pytest.mark.parametrize(('step', 'bound'), [(1e-3, 4e-9), (5e-4, 3e-10)])


@pytest.mark.slow
@pytest.mark.needs_numba
@STEPS
@pytest.mark.parametrize('strands', [BOTH_LONG, UNEQUAL])
@pytest.mark.parametrize('start', [(0.0, 0.0), (0.5, 0.0), (-0.3, 4.0)])
def test_a_pair_that_is_let_go_is_within_nanoradians_of_dop853(strands, start, step, bound):
    t = np.linspace(0.0, 5.0, 501)
    found = run(pair(strands), t, start, (4.2 * BAR, 2.9 * BAR), step)
    angle, rate = solve(joints.pair(lambda _: (4.2, 2.9), strands), start, t)
    assert np.ptp(angle) > 0.05
    assert np.max(np.abs(found[0] - angle)) < bound
    assert np.max(np.abs(found[1] - rate)) < 30.0 * bound


@pytest.mark.slow
@pytest.mark.needs_numba
@STEPS
@pytest.mark.parametrize('strands', [UNEQUAL, UNEQUAL[:1]], ids=['two', 'one'])
@pytest.mark.parametrize('start', [(0.0, 0.0), (0.5, 0.0), (-0.3, 2.0)])
def test_a_lever_that_is_let_go_is_within_nanoradians_of_dop853(strands, start, step, bound):
    """Two muscles, or one against the load, whose arms change with the angle."""
    t = np.linspace(0.0, 5.0, 501)
    bar = (3.2, 2.9) if len(strands) == 2 else (1.5,)
    found = run(lever(strands), t, start, BAR * np.array(bar), step)
    angle, rate = solve(joints.lever(lambda _: bar, strands), start, t)
    assert np.ptp(angle) > 0.05
    assert np.max(np.abs(angle)) < joints.AT_0 - 0.1
    assert np.max(np.abs(found[0] - angle)) < bound
    assert np.max(np.abs(found[1] - rate)) < 30.0 * bound


@pytest.mark.parametrize('start', [(0.0, 0.0), (0.05, 0.3)])
def test_a_mass_on_two_muscles_is_within_a_nanometre_of_dop853(start):
    t = np.linspace(0.0, 5.0, 501)
    found = run(parallel(MASS, offsets=OFFSETS), t, start, (4.2 * BAR, 2.9 * BAR))
    rhs = joints.parallel(lambda _: (4.2, 2.9), UNEQUAL, MASS, OFFSETS)
    s, v = solve(rhs, start, t)
    assert np.ptp(s) > 0.02
    assert np.max(np.abs(found[0] - s)) < 1e-9
    assert np.max(np.abs(found[1] - v)) < 3e-8


# Both muscles under pressures that swing, each in its own way.
SWINGS = ((3.0, 1.2, 5.0), (2.5, -0.8, 8.0))  # mean and amplitude in bar, rad/s


def swinging(t):
    return tuple(mean + amplitude * np.sin(rate * t) for mean, amplitude, rate in SWINGS)


def swung(t, step=1e-3, start=(0.1, 0.0)):
    supplies = tuple(
        {'smooth_supply': {'mean': mean * BAR, 'amplitude': amplitude * BAR, 'rate': rate}}
        for mean, amplitude, rate in SWINGS
    )
    model = pair(effects=supplies, library=(smooth_supply.EFFECT,))
    return run(model, t, start, step=step)


@pytest.mark.slow
@STEPS
def test_a_pair_under_swinging_pressures_is_within_nanoradians_of_dop853(step, bound):
    t = np.linspace(0.0, 5.0, 501)
    angle, rate = solve(joints.pair(swinging, UNEQUAL), (0.1, 0.0), t)
    found = swung(t, step)
    assert np.ptp(angle[t > 2.0]) > 0.3
    assert np.max(np.abs(found[0] - angle)) < bound
    assert np.max(np.abs(found[1] - rate)) < 30.0 * bound


@STEPS
def test_a_staircase_of_commands_is_within_nanoradians_of_dop853(step, bound):
    rig = Rig([pair()], step)
    rig.reset([3e5, 3e5], [0.0], [0.0])
    state = np.zeros(2)
    for k in range(100):
        p = 3.0 + np.sin(0.13 * k), 3.0 + np.cos(0.3 * k)
        rig.command(BAR * np.array(p))
        rig.advance(round(0.02 / step))
        rhs = joints.pair(lambda _, p=p: p, UNEQUAL)
        state = solve(rhs, state, np.array([0.0, 0.02]))[:, -1]
        assert rig.position[0] == pytest.approx(state[0], abs=bound)
    assert rig.time == pytest.approx(2.0, abs=1e-12)


def test_the_order_of_convergence_is_four():
    t = np.array([0.0, 0.96])
    exact = solve(joints.pair(swinging, UNEQUAL), (0.1, 0.0), t)[0, -1]
    steps = np.array([4e-3, 2e-3, 1e-3])
    errors = [abs(swung(t, step)[0, -1] - exact) for step in steps]
    orders = np.diff(np.log(errors)) / np.diff(np.log(steps))
    assert np.all(np.abs(orders - 4.0) < 0.3), orders


@pytest.mark.needs_numba
@pytest.mark.parametrize(
    ('made', 'torque', 'p'),
    [
        (pair, joints.torque, (4.0, 3.0)),
        (lever, joints.lever_torque, (4.0, 3.0)),
        (lever, joints.lever_torque, (1.5,)),
    ],
    ids=['pair', 'lever', 'crank'],
)
def test_energy_without_damping_drifts_by_a_millionth_in_a_minute(made, torque, p):
    """Motion, muscles and gravity: what one loses, the others gain."""
    strands = UNEQUAL[: len(p)]

    def energy(angle, rate):
        work, _ = quad(
            lambda a: torque(p, a, strands) - joints.gravity(a), 0.0, angle, epsabs=1e-13
        )
        return 0.5 * joints.J * rate**2 - work

    joint = made(strands, zeta=0.0)
    rig = Rig([joint])
    at_rest = rest(joint, BAR * np.array(p))
    away = at_rest + (0.4 if len(p) == 2 else -0.5)
    rig.reset(BAR * np.array(p), [away], [0.0])
    start = energy(away, 0.0)
    swing = start - energy(at_rest, 0.0)
    assert swing > (1.0 if len(p) == 2 else 0.5)
    drift = []
    for _ in range(60):
        rig.advance(1000)
        drift.append(energy(rig.position[0], rig.velocity[0]) - start)
    assert min(drift) > -1e-6 * swing
    assert max(drift) < 1e-7 * swing


def test_two_equal_muscles_are_one_with_half_the_mass():
    t = np.linspace(0.0, 2.0, 201)
    two = run(parallel(30.0, BOTH_LONG), t, (0.03, 0.1), (4e5, 4e5))
    alone = one_muscle(muscle(joints.LONG), Mass(mass=15.0))
    one = run(alone, t, (0.03, 0.1), (4e5,))
    np.testing.assert_allclose(two, one, rtol=0.0, atol=1e-12)


def test_a_pair_of_equal_muscles_rings_down_with_their_damping_ratio():
    """In the middle and for small swings, Lehr's ratio of the joint is that of its muscles."""
    same = {'contraction_1': 0.1, 'contraction_2': 0.1, 'plane': 'horizontal'}
    rig = Rig([pair(BOTH_LONG, zeta=0.08, **same)], 1e-4)
    rig.reset([3e5, 3e5], [1e-6], [0.0])
    peaks, last = [], (1e-6, 0.0)
    for _ in range(20_000):
        rig.advance()
        now = rig.position[0], rig.velocity[0]
        if last[1] > 0.0 >= now[1]:
            peaks.append(last[0])
        last = now
    decrement = np.log(peaks[0] / peaks[3]) / 3.0
    ratio = decrement / np.hypot(decrement, 2.0 * np.pi)
    assert ratio == pytest.approx(0.08, rel=1e-3)


def test_outputs_are_those_of_the_equations():
    rig = Rig([pair()])
    rig.reset([4.2e5, 2.9e5], [0.3], [2.0])
    p, y = (4.2, 2.9), joints.ends(0.3, UNEQUAL)
    found, (effort, stiffness, acceleration) = rig.outputs(), rig.joint_outputs()[0]
    k = [strand.stiffness(*each) for strand, *each in zip(UNEQUAL, p, y, strict=True)]
    for i, strand in enumerate(UNEQUAL):
        assert found[i, 0] == pytest.approx(strand.force(p[i], y[i]), abs=1e-8)
        assert found[i, 1] == pytest.approx(k[i], rel=1e-12)
        c = 2.0 * joints.ZETA * np.sqrt(joints.J / (2.0 * joints.R**2) * k[i])
        assert found[i, 2] == pytest.approx(c, rel=1e-12)
    tau = joints.torque(p, 0.3, UNEQUAL)
    assert effort == pytest.approx(tau, abs=1e-9)
    assert stiffness == pytest.approx(joints.R**2 * sum(k), rel=1e-12)
    net = tau - 2.0 * joints.drag(p, 0.3, UNEQUAL) - joints.gravity(0.3)
    assert acceleration == pytest.approx(net / joints.J, rel=1e-10)
    np.testing.assert_allclose(found[:, 3], [joints.R * acceleration, -joints.R * acceleration])
    l0 = [strand.l0 for strand in UNEQUAL]
    np.testing.assert_allclose(rig.contraction, np.divide(y, l0), rtol=1e-14)


def test_outputs_of_a_lever_are_those_of_the_equations():
    """The ends of the muscles accelerate also because their arms change: arm' v^2."""
    rig, angle, rate, h = Rig([lever()]), 0.3, 2.0, 1e-5
    rig.reset([4.2e5, 2.9e5], [angle], [rate])
    p, kappas = (4.2, 2.9), (joints.KAPPA_1, joints.KAPPA_2)
    y = [kappas[i] * strand.l0 + joints.drawn(angle, i) for i, strand in enumerate(UNEQUAL)]
    found, (effort, stiffness, acceleration) = rig.outputs(), rig.joint_outputs()[0]
    drag = 0.0
    for i, strand in enumerate(UNEQUAL):
        r = joints.lever_arm(angle, i)
        turn = (joints.lever_arm(angle + h, i) - joints.lever_arm(angle - h, i)) / (2.0 * h)
        assert found[i, 0] == pytest.approx(strand.force(p[i], y[i]), abs=1e-8)
        assert found[i, 1] == pytest.approx(strand.stiffness(p[i], y[i]), rel=1e-12)
        c = 2.0 * joints.ZETA * np.sqrt(joints.J / (2.0 * r**2) * found[i, 1])
        assert found[i, 2] == pytest.approx(c, rel=1e-12)
        assert found[i, 3] == pytest.approx(r * acceleration + turn * rate**2, rel=1e-8)
        drag += r**2 * c
    assert effort == pytest.approx(joints.lever_torque(p, angle, UNEQUAL), abs=1e-9)
    ends = (joints.lever_torque(p, angle + way, UNEQUAL) for way in (h, -h))
    assert stiffness == pytest.approx((next(ends) - next(ends)) / (-2.0 * h), rel=1e-7)
    net = effort - drag * rate - joints.gravity(angle)
    assert acceleration == pytest.approx(net / joints.J, rel=1e-10)
    np.testing.assert_allclose(rig.contraction, np.divide(y, [s.l0 for s in UNEQUAL]), rtol=1e-14)
