# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Simulation over given stamps: commands at their very moments, starts, forces, held joints.

Against closed forms, DOP853, the law of each muscle, and rigs that are stepped.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp, trapezoid

from pam_ros.effects import (
    CoulombFriction,
    Creep,
    DeadTime,
    EndStop,
    Hysteresis,
    Payload,
    PressureLag,
    ViscousFriction,
)
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.changes import acting_commands
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.loads import Mass
from pam_ros.rig.run import simulate, simulate_held
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support import joints, paper
from support.assertions import no_error
from support.joint_models import UNEQUAL, lever, pair, parallel
from support.joint_runs import CASES

# A force source of 1 N/Pa and a mass of 2 kg: y'' = p/2 has parabolas for solutions, exactly.
SOURCE = Muscle(
    a1=0.0, a2=0.0, a3=0.0, a4=0.0, a5=1.0, a6=0.0,
    pressure_unit='Pa', zeta=0.0, p_min=-1e3, p_max=1e3, force_max=1e3,
)  # fmt: skip
FREE = Mass(mass=2.0, mount='horizontal')


LATE = [DeadTime(delay=0.012)]
LATER = [DeadTime(delay=0.031), PressureLag(fill=0.03, vent=0.05)]
CREEP = [Creep(stiffness=300.0, time=0.5)]
AT = np.array([0.0, 0.1, 0.25, 0.26, 0.6])
U = 1e5 * np.array([[3.0, 3.0], [4.0, 2.5], [2.0, 3.5], [2.2, 3.5], [3.0, 3.2]])
T = np.arange(1001) * 1e-3
EACH = pytest.mark.parametrize('case', CASES.values(), ids=CASES)


def stepped(joint, begin):
    """Return position, velocity and pressures of a rig, each ms."""
    rig, muscles = Simulation([joint]), len(joint.muscles)
    rig.reset(U[0, :muscles], [begin], [0.0])
    commands = {round(stamp * 1e3): row for stamp, row in zip(AT, U[:, :muscles], strict=True)}
    found = []
    for k in range(T.size):
        found.append((rig.position[0], rig.velocity[0], *rig.pressure))
        if k in commands:
            rig.command(commands[k])
        rig.advance()
    return np.array(found).T


@pytest.mark.slow
@pytest.mark.parametrize(
    ('joint', 'bound'),
    [
        (single_muscle_joint(load=Mass(mass=8.0), effects=[*LATE, *CREEP]), 1e-12),
        (pair(effects=(LATE, LATER)), 1e-11),
        (lever(effects=(LATE, LATER)), 1e-11),
        (parallel(50.0), 1e-11),
    ],
    ids=['one muscle', 'pair', 'lever', 'parallel'],
)
def test_it_is_what_a_rig_gives_that_is_stepped(joint, bound):
    """Commands of each muscle on whole steps, each after the dead time of its own path."""
    muscles = len(joint.muscles)
    run = simulate(joint, T, U[:, :muscles], AT, position=0.02)
    position, velocity, *pressures = stepped(joint, 0.02)
    np.testing.assert_allclose(run.position, position, atol=bound)
    np.testing.assert_allclose(run.velocity, velocity, atol=10.0 * bound)
    shape = T.size if muscles == 1 else (T.size, muscles)
    np.testing.assert_allclose(run.pressure, np.transpose(pressures).reshape(shape), rtol=1e-9)
    assert np.ptp(run.position) > 0.005
    assert run.force.shape == run.pressure.shape


def parabolas(t, command_t, command, y, v, delay=0.0):
    """Return y and v of the free mass at the stamps t, piece by piece."""
    edges = np.asarray(command_t)[1:] + delay
    found, now, i = [], t[0], 0
    while i < len(edges) and edges[i] < t[0]:
        i += 1
    for stamp in t:
        while i < len(edges) and edges[i] < stamp:
            h, a = edges[i] - now, command[i] / 2.0
            y, v, now, i = y + h * v + 0.5 * a * h * h, v + a * h, edges[i], i + 1
        h, a = stamp - now, command[i] / 2.0
        y, v, now = y + h * v + 0.5 * a * h * h, v + a * h, stamp
        found.append((y, v))
    return np.array(found).T


# In whole microseconds: a command within 1 ns of a sample may act one sample off.
stamp = st.integers(0, 100_000).map(lambda n: n * 1e-6)
stamps = st.lists(stamp, min_size=1, max_size=12).map(sorted)


@settings(deadline=None)
@given(stamps, stamps, st.integers(0, 2**32 - 1), st.sampled_from([0.0, 0.004, 0.0137]))
def test_commands_act_at_their_very_stamps(t, command_t, seed, delay):
    command = np.random.default_rng(seed).uniform(-100.0, 100.0, len(command_t))
    model = single_muscle_joint(SOURCE, FREE, [DeadTime(delay=delay)])
    found = simulate(model, t, command, command_t, position=0.3, velocity=-0.1)
    y, v = parabolas(t, command_t, command, 0.3, -0.1, delay)
    np.testing.assert_allclose(found.position, y, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(found.velocity, v, rtol=0.0, atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(
    ('made', 'equations'), [(pair, joints.pair), (lever, joints.lever)], ids=['pair', 'lever']
)
def test_commands_act_at_their_very_stamps_in_each_muscle(made, equations):
    """Stamps between the steps, and a dead time that none of them divides: against DOP853."""
    delays, at = (0.0137, 0.0), np.array([0.0, 0.1003, 0.2371])
    u = np.array([[3.0, 2.0], [4.0, 2.5], [2.5, 3.0]])
    joint = made(effects=([DeadTime(delay=delays[0])], ()))
    run = simulate(joint, T[::10], 1e5 * u, at, position=0.1, step=5e-4)
    edges = np.unique(np.concatenate([at + delay for delay in delays]))
    state, now, found = np.array([0.1, 0.0]), 0.0, []
    for end in [*edges[edges > 0.0], T[-1]]:
        p = [
            u[max(np.searchsorted(at + delay, now + 1e-9) - 1, 0), i]
            for i, delay in enumerate(delays)
        ]
        inside = T[::10][(T[::10] >= now) & ((T[::10] < end) | (end == T[-1]))]
        part = solve_ivp(
            equations(lambda _, p=p: p, UNEQUAL),
            (now, end), state, 'DOP853', rtol=1e-12, atol=1e-14, dense_output=True,
        )  # fmt: skip
        found += list(part.sol(inside)[0])
        state, now = part.y[:, -1], end
    assert np.ptp(found) > 0.1
    np.testing.assert_allclose(run.position, found, atol=3e-9)


def test_a_sample_is_the_state_before_the_command_of_its_stamp():
    t = [0.0, 0.1, 0.2]
    found = simulate(single_muscle_joint(SOURCE, FREE), t, [0.0, 40.0], [0.0, 0.1], position=0.0)
    np.testing.assert_allclose(found.position, [0.0, 0.0, 0.1], atol=1e-15)
    np.testing.assert_array_equal(found.pressure, [0.0, 0.0, 40.0])
    np.testing.assert_array_equal(found.force, [0.0, 0.0, 40.0])


def test_viscous_friction_follows_its_exponential():
    """2 y'' = p - c y' with c = 5: v = p/c (1 - exp(-c t / m)); the step divides nothing."""
    model = single_muscle_joint(SOURCE, FREE, [ViscousFriction(coefficient=5.0)])
    t = np.array([0.0, 0.0123, 0.5, 0.50031, 2.0])
    found = simulate(model, t, [30.0], [0.0], position=0.0)
    rate, end = 5.0 / 2.0, 30.0 / 5.0
    np.testing.assert_allclose(found.velocity, end * (1.0 - np.exp(-rate * t)), atol=1e-11)
    y = end * (t - (1.0 - np.exp(-rate * t)) / rate)
    np.testing.assert_allclose(found.position, y, atol=1e-11)


@pytest.mark.parametrize(
    ('joint', 'command', 'acting'),
    [
        (single_muscle_joint(), [1e5, 3e5, 6e5], 3e5),
        (
            single_muscle_joint(effects=[PressureLag(fill=0.1, vent=0.1)]),
            [1e5, 3e5, 6e5],
            3e5,
        ),
        (
            lever(effects=([DeadTime(delay=0.3)], ())),
            [[2e5, 3e5], [4e5, 3.5e5], [6e5, 6e5]],
            [2e5, 3.5e5],
        ),
    ],
    ids=['one muscle', 'with lag', 'lever'],
)
def test_it_starts_at_rest_under_the_commands_in_force(joint, command, acting):
    """Of each muscle the last before the first sample, if it has acted; a lag has followed."""
    run = simulate(joint, [2.2, 2.25], command, [1.0, 2.0, 6.0])
    np.testing.assert_allclose(run.pressure, [acting] * 2, rtol=1e-15)
    np.testing.assert_allclose(run.position, equilibrium(joint, acting), atol=1e-12)


def test_a_late_command_is_not_yet_in_force_at_the_start():
    model = single_muscle_joint(effects=[DeadTime(delay=0.3)])
    found = simulate(model, [2.2, 2.3, 2.4], [1e5, 3e5], [1.0, 2.0])
    np.testing.assert_array_equal(found.pressure, [1e5, 1e5, 3e5])


@EACH
def test_the_force_of_each_muscle_is_its_pull_less_its_damping(case):
    joint = case.made(effects=(LATE, LATER))
    run = simulate(joint, T, U[:, : len(joint.muscles)], AT, position=0.02, velocity=0.2)
    for k in range(0, T.size, 50):
        p, found = np.atleast_1d(run.pressure[k]), np.atleast_1d(run.force[k])
        expected = case.forces(p, run.position[k], run.velocity[k])
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-8)


def test_a_step_that_is_too_long_is_refused_with_a_sentence():
    with pytest.raises(ParameterError) as error:
        simulate(single_muscle_joint(), [0.0, 1.0], [0.0], [0.0], step=0.02)
    assert str(error.value) == (
        'a physics step of 20 ms does not resolve a mass of 20 kg on this muscle: give at least '
        '148 steps a second, or more mass'
    )


def test_commands_of_other_muscles_are_refused_with_a_sentence():
    three = np.zeros((2, 3))
    with pytest.raises(ParameterError) as error:
        simulate(pair(), [0.0, 0.1], three)
    assert str(error.value) == (
        'command has the shape (2, 3): give (2, 2), a row for each stamp of t and a '
        'column for each muscle'
    )
    with pytest.raises(ParameterError, match=r'pressure has the shape \(2, 3\): give \(2, 2\)'):
        simulate_held(pair(), [0.0, 0.1], three, [0.0, 0.0])


def test_commands_with_different_dead_times_act_at_all_their_stamps():
    at, u = np.array([0.0, 1.0]), np.array([[1.0, 2.0], [3.0, 4.0]])
    stamps, acting = acting_commands([at + 0.5, at + 0.2], u)
    np.testing.assert_array_equal(stamps, [0.2, 0.5, 1.2, 1.5])
    np.testing.assert_array_equal(acting, [[1.0, 2.0], [1.0, 2.0], [1.0, 4.0], [3.0, 4.0]])
    same, unchanged = acting_commands([at + 0.5, at + 0.5], u)
    np.testing.assert_array_equal(same, at + 0.5)
    assert unchanged is u


# Held -----------------------------------------------------------------------------------------


@pytest.mark.slow
@EACH
def test_a_joint_that_is_held_gives_the_forces_of_the_law(case):
    """Coordinate and pressures prescribed."""
    t = np.linspace(0.0, 2.0, 101)
    joint = case.made()
    p = np.stack([3e5 + 1e5 * np.sin(3.0 * t), 2.5e5 + 5e4 * np.cos(2.0 * t)], axis=1)
    p = p[:, : len(joint.muscles)]
    s = 0.3 * np.sin(2.0 * t) if joint.is_revolute else 0.05 + 0.02 * np.sin(2.0 * t)
    run = simulate_held(joint, t, p, s)
    rate = np.gradient(s, t)
    for k in range(t.size):
        expected = case.forces(p[k], s[k], rate[k])
        np.testing.assert_allclose(np.atleast_1d(run.force[k]), expected, rtol=0.0, atol=1e-8)
    np.testing.assert_array_equal(run.position, s)
    np.testing.assert_array_equal(run.velocity, rate)
    np.testing.assert_array_equal(run.pressure, p if p.shape[1] > 1 else p[:, 0])


def test_a_held_rig_takes_a_given_velocity():
    t, p, y = [0.0, 0.1], [2e5, 2e5], [0.02, 0.02]
    still = simulate_held(single_muscle_joint(), t, p, y)
    moving = simulate_held(single_muscle_joint(), t, p, y, velocity=[0.0, 0.5])
    c = paper.damping(2.0, 5.0, 20.0, 0.15)
    np.testing.assert_allclose(moving.force - still.force, [0.0, -0.5 * c], atol=1e-9)


@pytest.mark.slow
def test_each_held_muscle_feels_its_pressure_after_its_own_dead_time():
    t = np.linspace(0.0, 2.0, 401)
    p = np.stack([3e5 + 1e5 * np.sin(6.0 * t), 2e5 + 5e4 * np.cos(4.0 * t)], axis=1)
    effects = [DeadTime(delay=0.0237)], [DeadTime(delay=0.1)]
    run = simulate_held(lever(effects=effects), t, p, 0.0 * t + 0.2)
    for i, delay in enumerate((0.0237, 0.1)):
        expected = np.interp(t - delay, t, p[:, i])
        np.testing.assert_allclose(run.pressure[:, i], expected, rtol=1e-12)


@pytest.mark.slow
def test_isometric_muscles_have_separate_memories_and_no_friction_of_the_joint():
    """Slip of one muscle over its own contraction, at any step; the load's effects are none."""
    slip = [Hysteresis(slip=9.0, slip_width=0.02, slip_onset=1.0)]
    t = np.linspace(0.0, 1.0, 201)
    s = 0.4 * np.sin(2.0 * np.pi * t)
    p, still = np.full((201, 2), 3e5), 0.0 * t
    rub = [CoulombFriction(level=2.0)]
    bare, one = (
        simulate_held(pair(effects=((), own), load=rub), t, p, s, still) for own in ((), slip)
    )
    np.testing.assert_array_equal(bare.force[:, 0], one.force[:, 0])
    # Ten elements of one threshold are one play: the force is within 9 N, and at its end there.
    kappa = np.array([joints.ends(a, UNEQUAL)[1] for a in s]) / UNEQUAL[1].l0
    play, expected = kappa[0], []
    for k in kappa:
        play = np.clip(play, k - 0.02, k + 0.02)
        expected.append(-9.0 * (k - play) / 0.02)
    np.testing.assert_allclose(one.force[:, 1] - bare.force[:, 1], expected, atol=1e-9)
    assert np.ptp(expected) == pytest.approx(18.0)


def friction_by_hand(y, level, up, down, presliding):
    """Return the friction of a spring that slides at (1 + up), (1 - down) of *level* (n,)."""
    found, spring = [], 0.0
    for k in range(y.size):
        spring += (level[k] / presliding) * (y[k] - y[k - 1] if k else 0.0)
        spring = min(max(spring, -(1.0 - down) * level[k]), (1.0 + up) * level[k])
        found.append(spring)
    return np.array(found)


def test_friction_is_in_the_force_of_a_machine_that_moves_the_actuator():
    """To and fro at 12 mm/s at two pressures: pull - friction up, pull + friction down."""
    t = np.arange(0.0, 4.0, 0.01)
    y = 0.012 * np.abs((t + 0.5) % 2.0 - 1.0)
    v = np.where((t + 0.5) % 2.0 < 1.0, -0.012, 0.012)
    p = np.where(t < 2.1, 200.0, 600.0)
    frictions = [
        CoulombFriction(level=5.0, per_pressure=1e-2, asymmetry=0.1, presliding=1e-4),
        ViscousFriction(coefficient=150.0),
    ]
    plain = simulate_held(single_muscle_joint(SOURCE, FREE), t, p, y, v)
    run = simulate_held(single_muscle_joint(SOURCE, FREE, frictions), t, p, y, v)
    np.testing.assert_array_equal(plain.force, p)
    dry = friction_by_hand(y, 5.0 + 1e-2 * p, 0.1, 0.1, 1e-4)
    np.testing.assert_allclose(run.force, p - dry - 150.0 * v, rtol=0.0, atol=1e-9)
    slides = (t > 0.55) & (t < 1.45)
    np.testing.assert_allclose(run.force[slides], 200.0 - 1.1 * 7.0 - 1.8, atol=1e-9)
    slides = (t > 1.55) & (t < 2.05)
    np.testing.assert_allclose(run.force[slides], 200.0 + 0.9 * 7.0 + 1.8, atol=1e-9)


def test_friction_of_a_machine_takes_work_at_any_step_and_mass():
    """Nothing swings on the contact: neither step nor load is in what a machine measures."""
    t = np.linspace(0.0, 6.0, 601)
    y = 0.02 * np.sin(2.0 * t)
    friction = [CoulombFriction(level=8.0, breakaway=12.0)]
    runs = [
        simulate_held(
            single_muscle_joint(SOURCE, Mass(mass=mass), friction), t, 0.0 * t, y, step=step
        )
        for mass, step in ((0.01, 1e-2), (50.0, 1e-2), (50.0, 2e-3))
    ]
    for run in runs:
        work = trapezoid(run.force, y)
        assert -12.0 < work / np.sum(np.abs(np.diff(y))) < -8.0
    np.testing.assert_array_equal(runs[0].force, runs[1].force)
    # In the turns a longer step passes more of the Stribeck curve at once.
    np.testing.assert_allclose(runs[1].force, runs[2].force, atol=0.1)


def test_what_acts_on_the_load_alone_is_not_in_the_force_of_a_machine():
    t = np.linspace(0.0, 3.0, 301)
    y, p = 0.04 + 0.04 * np.sin(3.0 * t), np.full(t.size, 3e5)
    beside = [Payload(mass=4.0), EndStop(upper=0.1, stiffness=1e5)]
    alone, loaded = (
        simulate_held(single_muscle_joint(effects=some), t, p, y) for some in ((), beside)
    )
    # The mass is in the damping of equation (4): the payload there is that of the muscle's own.
    still = np.abs(alone.velocity) < 1e-3
    assert still.any()
    np.testing.assert_allclose(loaded.force[still], alone.force[still], rtol=0.0, atol=0.1)


def test_friction_of_a_wheel_is_not_in_the_force_of_its_muscles():
    """The force cells are at the ends of the muscles, the bearing is not."""
    t = np.linspace(0.0, 2.0, 201)
    angle, p = 0.2 * np.sin(3.0 * t), np.full((t.size, 2), 2e5)
    rubs = [CoulombFriction(level=2.0), ViscousFriction(coefficient=1.0)]
    plain = simulate_held(pair(), t, p, angle)
    np.testing.assert_array_equal(simulate_held(pair(load=rubs), t, p, angle).force, plain.force)


@pytest.mark.parametrize('command', [300.0, -3.0, [[4.0, 0.0], [0.0, 600.0]]])
def test_pressures_in_kpa_are_warned_of(command):
    many = isinstance(command, list)
    joint = pair() if many else single_muscle_joint(Muscle(), Mass(mass=5.0))
    stamps = [0.0, 0.1] if many else [0.0]
    with pytest.warns(UserWarning, match='command reaches .* Pa only, and p_max is 6') as w:
        simulate(joint, [0.0, 0.1], command if many else [command], stamps)
    assert w[0].filename == __file__
    held = np.broadcast_to(command, (2, 2)) if many else [command, command]
    with pytest.warns(UserWarning, match='pressure reaches .* Pa only'):
        simulate_held(joint, [0.0, 0.1], held, [0.02, 0.02])


def test_pressures_that_may_be_meant_are_not_warned_of():
    joint = single_muscle_joint(Muscle(), Mass(mass=5.0))
    for command in (0.0, 700.0, 3e5):
        with no_error():  # warnings are errors here
            simulate(joint, [0.0, 0.1], [0.0, command], [0.0, 0.05])


@pytest.mark.needs_numba  # plain Python warns of the overflow
def test_commands_too_high_for_a_finite_motion_are_refused_with_a_sentence():
    t = np.arange(0.0, 2.0, 0.01)
    with (
        pytest.warns(UserWarning, match='the force law is not valid there'),
        pytest.raises(ParameterError) as error,
    ):
        simulate(single_muscle_joint(), t, [3e5, 1e300], [0.0, 1.0])
    assert str(error.value) == (
        'the motion is not finite from 1.01 s on: command reaches 1e+300 Pa, and p_max is 600000 '
        'Pa'
    )


def test_commands_may_share_the_stamps_of_the_samples():
    t = 0.01 * np.arange(200)
    command = 3e5 + 1e5 * np.sin(5.0 * t)
    run, apart = (simulate(single_muscle_joint(), t, command, at) for at in (None, t))
    np.testing.assert_array_equal(run.position, apart.position)
    with pytest.raises(ParameterError, match='one number for each stamp of t'):
        simulate(single_muscle_joint(), t, command[:-1])
