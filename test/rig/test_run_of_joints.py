# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of joints with two muscles over stamps: against rigs that are stepped, and equations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pam_ros.errors import ParameterError
from pam_ros.rig.rest import rest
from pam_ros.rig.rig import Rig
from pam_ros.rig.run import acting_commands, simulate, simulate_held
from support import joints
from support.joint_models import UNEQUAL, lever, pair, parallel

LATE = {'dead_time': {'delay': 0.012}}
LATER = {'dead_time': {'delay': 0.031}, 'pressure_lag': {'fill': 0.03, 'vent': 0.05}}
AT = np.array([0.0, 0.1, 0.25, 0.26, 0.6])
U = 1e5 * np.array([[3.0, 3.0], [4.0, 2.5], [2.0, 3.5], [2.2, 3.5], [3.0, 3.2]])
T = np.arange(1001) * 1e-3


def heavy(**more):
    """Return 50 kg on two muscles."""
    return parallel(50.0, **more)


def stepped(joint, begin):
    """Return position, velocity, and pressures, pulls and dampings of a rig, each ms."""
    rig = Rig([joint])
    rig.reset(U[0], [begin], [0.0])
    commands = {round(stamp * 1e3): row for stamp, row in zip(AT, U, strict=True)}
    found = []
    for k in range(T.size):
        out = rig.outputs()
        found.append((rig.position[0], rig.velocity[0], *rig.pressure, *out[:, 0], *out[:, 2]))
        if k in commands:
            rig.command(commands[k])
        rig.advance()
    return np.array(found).T


@pytest.mark.slow
@pytest.mark.parametrize(
    ('made', 'effects'),
    [(pair, (LATE, LATER)), (lever, (LATE, LATER)), (heavy, ({}, {}))],
    ids=['pair', 'lever', 'parallel'],
)
def test_it_is_what_a_rig_gives_that_is_stepped(made, effects):
    """Commands of two muscles on whole steps, each after the dead time of its own path."""
    joint = made(effects=effects)
    run = simulate(joint, T, AT, U, position=0.02)
    position, velocity, *pressures = stepped(joint, 0.02)[:4]
    np.testing.assert_allclose(run.position, position, atol=1e-11)
    np.testing.assert_allclose(run.velocity, velocity, atol=1e-9)
    np.testing.assert_allclose(run.pressure, np.transpose(pressures), rtol=1e-9)
    assert np.ptp(run.position) > 0.005
    assert run.force.shape == run.pressure.shape == (T.size, 2)


@pytest.mark.parametrize(
    ('made', 'arms'),
    [
        (pair, lambda s: np.array([joints.R, -joints.R])),
        (lever, lambda s: np.array([joints.lever_arm(s, i) for i in (0, 1)])),
    ],
    ids=['pair', 'lever'],
)
def test_the_force_of_each_muscle_is_its_pull_less_its_damping(made, arms):
    joint = made(effects=(LATE, LATER))
    run = simulate(joint, T, AT, U, position=0.02)
    found = stepped(joint, 0.02)
    for k in range(0, T.size, 50):
        pull, damping = found[4:6, k], found[6:8, k]
        expected = pull - damping * arms(found[0, k]) * found[1, k]
        np.testing.assert_allclose(run.force[k], expected, atol=1e-5)


@pytest.mark.slow
def test_commands_act_at_their_very_stamps_in_each_muscle():
    """Stamps between the steps, and a dead time that none of them divides: against DOP853."""
    delays, at = (0.0137, 0.0), np.array([0.0, 0.1003, 0.2371])
    u = np.array([[3.0, 2.0], [4.0, 2.5], [2.5, 3.0]])
    effects = {'dead_time': {'delay': delays[0]}}, {}
    for made, equations in ((pair, joints.pair), (lever, joints.lever)):
        run = simulate(made(effects=effects), T[::10], at, 1e5 * u, position=0.1, step=5e-4)
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


def test_it_starts_at_rest_under_the_commands_in_force():
    """Of each muscle the last command that has acted: a late one has not."""
    joint = lever(effects=({'dead_time': {'delay': 0.3}}, {}))
    run = simulate(joint, [2.2, 2.25], [1.0, 2.0], [[2e5, 3e5], [4e5, 3.5e5]])
    np.testing.assert_array_equal(run.pressure, [[2e5, 3.5e5]] * 2)
    np.testing.assert_allclose(run.position, rest(joint, [2e5, 3.5e5]), atol=1e-12)


def test_commands_of_other_muscles_are_refused_with_a_sentence():
    three = np.zeros((2, 3))
    with pytest.raises(ParameterError) as error:
        simulate(pair(), [0.0, 0.1], [0.0, 0.1], three)
    assert str(error.value) == (
        'command has the shape (2, 3): give (2, 2), a row for each stamp of command_t and a '
        'column for each muscle'
    )
    with pytest.raises(ParameterError, match=r'pressure has the shape \(2, 3\): give \(2, 2\)'):
        simulate_held(pair(), [0.0, 0.1], three, [0.0, 0.0])


def test_commands_with_different_dead_times_act_at_all_their_stamps():
    at, u = np.array([0.0, 1.0]), np.array([[1.0, 2.0], [3.0, 4.0]])
    stamps, acting = acting_commands(at, u, (0.5, 0.2))
    np.testing.assert_array_equal(stamps, [0.2, 0.5, 1.2, 1.5])
    np.testing.assert_array_equal(acting, [[1.0, 2.0], [1.0, 2.0], [1.0, 4.0], [3.0, 4.0]])
    same, unchanged = acting_commands(at, u, (0.5, 0.5))
    np.testing.assert_array_equal(same, at + 0.5)
    assert unchanged is u


# Held -----------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(
    ('made', 'ends', 'arms'),
    [
        (pair, lambda s: joints.ends(s, UNEQUAL), lambda s: (joints.R, -joints.R)),
        (
            lever,
            lambda s: [
                kappa * strand.l0 + joints.drawn(s, i)
                for i, (kappa, strand) in enumerate(
                    zip((joints.KAPPA_1, joints.KAPPA_2), UNEQUAL, strict=True)
                )
            ],
            lambda s: [joints.lever_arm(s, i) for i in (0, 1)],
        ),
    ],
    ids=['pair', 'lever'],
)
def test_a_joint_that_is_held_gives_the_forces_of_the_law(made, ends, arms):
    """Coordinate and pressures prescribed: equation (1) less (4) times the muscle's speed."""
    t = np.linspace(0.0, 2.0, 101)
    p = np.stack([3e5 + 1e5 * np.sin(3.0 * t), 2.5e5 + 5e4 * np.cos(2.0 * t)], axis=1)
    s = 0.3 * np.sin(2.0 * t)
    run = simulate_held(made(), t, p, s)
    rate = np.gradient(s, t)
    for k in range(t.size):
        for i, (strand, y, r) in enumerate(zip(UNEQUAL, ends(s[k]), arms(s[k]), strict=True)):
            bar = p[k, i] / 1e5
            c = 2.0 * joints.ZETA * np.sqrt(joints.J / (2.0 * r**2) * strand.stiffness(bar, y))
            expected = strand.force(bar, y) - c * r * rate[k]
            assert run.force[k, i] == pytest.approx(expected, abs=1e-8)
    np.testing.assert_array_equal(run.position, s)
    np.testing.assert_array_equal(run.velocity, rate)
    np.testing.assert_array_equal(run.pressure, p)


@pytest.mark.slow
def test_each_held_muscle_feels_its_pressure_after_its_own_dead_time():
    t = np.linspace(0.0, 2.0, 401)
    p = np.stack([3e5 + 1e5 * np.sin(6.0 * t), 2e5 + 5e4 * np.cos(4.0 * t)], axis=1)
    effects = {'dead_time': {'delay': 0.0237}}, {'dead_time': {'delay': 0.1}}
    run = simulate_held(lever(effects=effects), t, p, 0.0 * t + 0.2)
    for i, delay in enumerate((0.0237, 0.1)):
        expected = np.interp(t - delay, t, p[:, i])
        np.testing.assert_allclose(run.pressure[:, i], expected, rtol=1e-12)


@pytest.mark.slow
def test_held_muscles_remember_apart_and_friction_of_the_joint_is_not_felt():
    """Slip of one muscle over its own contraction, at any step; the load's effects are none."""
    slip = {'hysteresis': {'slip': 9.0, 'slip_width': 0.02, 'slip_onset': 1.0}}
    t = np.linspace(0.0, 1.0, 201)
    s = 0.4 * np.sin(2.0 * np.pi * t)
    p, still = np.full((201, 2), 3e5), 0.0 * t
    rub = {'coulomb_friction': {'level': 2.0}}
    bare, one = (
        simulate_held(pair(effects=({}, own), load=rub), t, p, s, still) for own in ({}, slip)
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
