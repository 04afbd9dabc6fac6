# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The integrator against scipy's DOP853 on equations of their own, and against conservation."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import layout as at
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.joint import Joint
from pam_ros.rig.loads import Mass
from pam_ros.rig.run import simulate
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.start import start_state
from support import joints, paper, smooth_supply
from support.joint_models import BOTH_LONG, UNEQUAL, lever, muscle, pair, parallel
from support.joint_runs import BAR, OFFSETS, run, solve
from support.joint_runs import MASS as ON_TWO

MASS, ZETA = 20.0, 0.15
WEIGHT = MASS * paper.G


def hanging(p_of_t, g=paper.G):
    """Return the paper's equations, upwards, as a right-hand side for scipy."""
    downwards = paper.pendulum(lambda t: p_of_t(t)[0], MASS, ZETA, g)

    def rhs(t, state):
        v, a = downwards(t, (-state[0], -state[1]))
        return -v, -a

    return rhs


@dataclass(frozen=True)
class Case:
    """A joint, its equations, pressures in bar, and what is allowed at each step.

    A nanometre at the ends of the muscles: 1 nm of a load that hangs there, and on an arm 4 nrad
    are a tenth of a nanometre; with half the step 0.3 nrad.
    """

    joint: Joint
    equations: Any
    bar: tuple
    bounds: tuple = ((1e-3, 4e-9), (5e-4, 3e-10))
    moves: float = 0.05

    def constant(self):
        return self.equations(lambda _: self.bar)


ALONE = Case(single_muscle_joint(), hanging, (6.0,), ((1e-3, 1e-9),), 0.0)
TWO = Case(pair(), lambda p: joints.pair(p, UNEQUAL), (4.2, 2.9))
CASES = {
    'one muscle': (ALONE, (0.0, 0.0), (0.05, 0.0), (0.0973, 0.0)),
    'parallel': (
        Case(
            parallel(ON_TWO, offsets=OFFSETS),
            lambda p: joints.parallel(p, UNEQUAL, ON_TWO, OFFSETS),
            *((4.2, 2.9), ((1e-3, 1e-9),), 0.02),
        ),
        *((0.0, 0.0), (0.05, 0.3)),
    ),
    'pair': (TWO, (0.0, 0.0), (0.5, 0.0), (-0.3, 4.0)),
    'equal pair': (
        Case(pair(BOTH_LONG), lambda p: joints.pair(p, BOTH_LONG), (4.2, 2.9)),
        *((0.0, 0.0), (0.5, 0.0), (-0.3, 4.0)),
    ),
    # The arms of levers change with the angle.
    'lever': (
        Case(lever(), lambda p: joints.lever(p, UNEQUAL), (3.2, 2.9)),
        *((0.0, 0.0), (0.5, 0.0), (-0.3, 2.0)),
    ),
    'crank': (
        Case(lever(UNEQUAL[:1]), lambda p: joints.lever(p, UNEQUAL[:1]), (1.5,)),
        *((0.0, 0.0), (0.5, 0.0), (-0.3, 2.0)),
    ),
}


def marks_of(case):
    return [pytest.mark.needs_numba] if case.joint.is_revolute else []


@pytest.mark.parametrize(
    ('case', 'start'),
    [
        pytest.param(case, start, id=f'{name} from {start}', marks=marks_of(case))
        for name, (case, *starts) in CASES.items()
        for start in starts
    ],
)
def test_a_joint_that_is_let_go_is_within_a_nanometre_of_dop853(case, start):
    """One muscle is the paper's experiment: 600 kPa, 20 kg, released."""
    t = np.linspace(0.0, 10.0, 1001) if case is ALONE else np.linspace(0.0, 5.0, 501)
    s, v = solve(case.constant(), start, t)
    assert np.ptp(s) > case.moves
    if case.joint.transmission.equations.name == 'lever':
        assert np.max(np.abs(s)) < joints.AT_0 - 0.1
    for step, bound in case.bounds:
        found = run(case.joint, t, start, BAR * np.array(case.bar), step)
        assert np.max(np.abs(found[0] - s)) < bound
        assert np.max(np.abs(found[1] - v)) < 30.0 * bound


def test_the_experiment_of_the_paper_comes_to_rest():
    found = simulate(single_muscle_joint(), [0.0, 10.0], [6e5], [0.0], position=0.05)
    assert found.force[-1] == pytest.approx(WEIGHT, abs=1e-6)


# Muscles under pressures that swing, each in its own way.
SWINGS = ((3.0, 1.2, 5.0), (2.5, -0.8, 8.0))  # mean and amplitude in bar, rad/s
SUPPLIES = tuple(
    [smooth_supply.SmoothSupply(mean=mean * BAR, amplitude=amplitude * BAR, rate=rate)]
    for mean, amplitude, rate in SWINGS
)
LIBRARY = (smooth_supply.SmoothSupply,)


def swinging(t):
    return tuple(mean + amplitude * np.sin(rate * t) for mean, amplitude, rate in SWINGS)


@dataclass(frozen=True)
class Swing:
    """A joint whose pressures swing, and the right-hand side of its equations."""

    joint: Joint
    rhs: Any
    bounds: tuple
    steps: tuple
    moves: float


EACH_SWING = pytest.mark.parametrize(
    'swing',
    [
        Swing(
            single_muscle_joint(
                effects=[smooth_supply.SmoothSupply(mean=smooth_supply.MEAN)], library=LIBRARY
            ),
            hanging(lambda t: (smooth_supply.at(t),)),
            *(ALONE.bounds, (6e-3, 3e-3, 1.5e-3, 0.75e-3), 0.01),
        ),
        Swing(
            pair(effects=SUPPLIES, library=LIBRARY),
            joints.pair(swinging, UNEQUAL),
            *(TWO.bounds, (4e-3, 2e-3, 1e-3), 0.3),
        ),
    ],
    ids=['one muscle', 'pair'],
)


def swung(swing, t, step):
    return run(swing.joint, t, (0.1, 0.0), np.zeros(len(swing.joint.muscles)), step)


@pytest.mark.slow
@EACH_SWING
def test_under_swinging_pressures_it_is_within_a_nanometre_of_dop853(swing):
    t = np.linspace(0.0, 10.0, 1001)
    s, v = solve(swing.rhs, (0.1, 0.0), t)
    assert np.ptp(s[t > 5.0]) > swing.moves
    for step, bound in swing.bounds:
        found = swung(swing, t, step)
        assert np.max(np.abs(found[0] - s)) < bound
        assert np.max(np.abs(found[1] - v)) < 30.0 * bound


@EACH_SWING
def test_the_order_of_convergence_is_four(swing):
    t = np.array([0.0, 0.96])
    exact = solve(swing.rhs, (0.1, 0.0), t)[0, -1]
    errors = [abs(swung(swing, t, step)[0, -1] - exact) for step in swing.steps]
    orders = np.diff(np.log(errors)) / np.diff(np.log(swing.steps))
    assert np.all(np.abs(orders - 4.0) < 0.3), orders
    # Richardson sees the same order without a reference.
    y = [swung(swing, t, step)[0, -1] for step in (4e-3, 2e-3, 1e-3)]
    assert np.log2((y[0] - y[1]) / (y[1] - y[2])) == pytest.approx(4.0, abs=0.2)


@pytest.mark.parametrize('case', [ALONE, TWO], ids=['one muscle', 'pair'])
def test_a_staircase_of_commands_is_within_a_nanometre_of_dop853(case):
    """Commands at 50 Hz, each held to the next: the solver starts again at each."""
    muscles = len(case.joint.muscles)
    start = 0.0 if case is TWO else equilibrium(case.joint, 3e5)
    rigs = [Simulation([case.joint], step) for step, _ in case.bounds]
    for rig in rigs:
        rig.reset([3e5] * muscles, [start], [0.0])
    state = np.array([start, 0.0])
    for k in range(150):
        p = (3.0 + 2.0 * np.sin(0.13 * k), 3.0 + np.cos(0.3 * k))[:muscles]
        state = solve(case.equations(lambda _, p=p: p), state, np.array([0.0, 0.02]))[:, -1]
        for rig, (step, bound) in zip(rigs, case.bounds, strict=True):
            rig.command(BAR * np.array(p))
            rig.advance(round(0.02 / step))
            assert rig.position[0] == pytest.approx(state[0], abs=bound)
    assert [rig.time for rig in rigs] == [3.0] * len(rigs)


def energy(rig):
    """Return the energy in J of the undamped paper's rig at 600 kPa, by the paper's force."""
    y, v = rig.position[0], rig.velocity[0]
    work, _ = quad(lambda s: paper.force(6.0, 100.0 * s / paper.L0), 0.0, y, epsabs=1e-13)
    return 0.5 * MASS * v * v + WEIGHT * y - work


@pytest.mark.needs_numba
def test_energy_without_damping_drifts_by_a_ten_millionth_in_a_minute():
    """Swinging by 75 mm with 9.7 J: the scheme takes 1.1e-8 J a second and gives none."""
    model = single_muscle_joint(Muscle(zeta=0.0))
    rig = Simulation([model])
    rig.reset([6e5], [equilibrium(model, 6e5)], [0.0])
    bottom = energy(rig)
    rig.reset([6e5], [0.06], [0.0])
    start = energy(rig)
    assert start - bottom == pytest.approx(9.7087, abs=1e-3)
    drift = []
    for _ in range(60):
        rig.advance(1000)
        drift.append(energy(rig) - start)
    assert min(drift) > -1e-6
    assert max(drift) < 1e-7  # it comes and goes by that much within a period
    # It is the scheme's own loss, a fifth power of the step, and not a fault: half the step,
    # a thirty-second of the loss.
    fine = Simulation([model], 5e-4)
    fine.reset([6e5], [0.06], [0.0])
    fine.advance(120_000)
    assert (energy(fine) - start) / drift[-1] == pytest.approx(1.0 / 32.0, rel=0.2)


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
    rig = Simulation([joint])
    at_rest = equilibrium(joint, BAR * np.array(p))
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


def test_a_horizontal_load_feels_no_gravity():
    model = single_muscle_joint(load=Mass(mount='horizontal'))
    t = np.linspace(0.0, 3.0, 301)
    found = simulate(model, t, [3e5], [0.0], position=0.05)
    y, _ = solve(hanging(lambda _: (3.0,), g=0.0), (0.05, 0.0), t)
    assert np.max(np.abs(found.position - y)) < 1e-9
    assert found.position[-1] == pytest.approx(equilibrium(model, 3e5), abs=1e-5)
    assert found.force[-1] == pytest.approx(0.0, abs=0.1)


def test_two_equal_muscles_are_one_with_half_the_mass():
    t = np.linspace(0.0, 2.0, 201)
    two = run(parallel(30.0, BOTH_LONG), t, (0.03, 0.1), (4e5, 4e5))
    alone = single_muscle_joint(muscle(joints.LONG), Mass(mass=15.0))
    one = run(alone, t, (0.03, 0.1), (4e5,))
    np.testing.assert_allclose(two, one, rtol=0.0, atol=1e-12)


def test_a_pair_of_equal_muscles_rings_down_with_their_damping_ratio():
    """In the middle and for small swings, Lehr's ratio of the joint is that of its muscles."""
    same = {'contraction_1': 0.1, 'contraction_2': 0.1, 'plane': 'horizontal'}
    rig = Simulation([pair(BOTH_LONG, zeta=0.08, **same)], 1e-4)
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


def test_templates_run_as_they_stand():
    """Unbound and uncompiled they are the paper's rig, as their module says."""
    from pam_ros.rig import kernel

    model = single_muscle_joint(library=())
    q = model.parameters()
    x = start_state(model.layout, q, [3e5], 0.02, 0.0)
    scratch = model.layout.scratch()
    for i in range(50):
        kernel.step(x, scratch, q, [3e5], i * 1e-3, 1e-3)
    y, v = solve(hanging(lambda _: (3.0,)), (0.02, 0.0), np.array([0.0, 0.05]))
    assert x[at.JOINT, at.S] == pytest.approx(y[-1], abs=1e-9)
    assert x[at.JOINT, at.V] == pytest.approx(v[-1], abs=3e-8)
