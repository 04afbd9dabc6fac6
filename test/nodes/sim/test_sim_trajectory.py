# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What ``pam_sim`` publishes against equations of the test's own, solved by scipy's DOP853."""

from dataclasses import dataclass
from itertools import pairwise
from math import exp, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

from support.harness import Program, lose_nothing

# DMSP-20-400N for p in bar and contraction in percent, as printed.
A1, A2, A3, A4, A5, A6 = -4.35573, 281.22370, -0.32866, -9.27035, 302.20107, -263.69185
L0, ZETA, MASS, G, AMBIENT = 0.4, 0.15, 20.0, 9.80665, 101325.0
RELEASED = {
    'initial.pressure': 600e3,
    'initial.at_rest': False,
    'initial.position': 0.0,
    **lose_nothing(),
}


def spring(p, y):
    """Return force in N and stiffness in N/m at p Pa and y m, in the constants' own units."""
    bar, percent = p / 1e5, 100.0 * y / L0
    e = exp(A3 * percent)
    force = (A1 * bar + A2) * e + A4 * percent * bar + A5 * bar + A6
    per_percent = (A1 * bar + A2) * A3 * e + A4 * bar
    return force, -per_percent * 100.0 / L0


def motion(p, y, v):
    force, k = spring(p, y)
    return [v, (force - 2.0 * ZETA * sqrt(MASS * k) * v) / MASS - G]


def solve(p, y, v, t):
    """Return positions and velocities at t (n,), from (y, v) at t[0], at constant pressure."""
    result = solve_ivp(
        lambda _, x: motion(p, *x),
        (t[0], t[-1]),
        [y, v],
        'DOP853',
        t_eval=t,
        rtol=1e-11,
        atol=1e-13,
    )
    return result.y


@dataclass
class Track:
    """What a run published, as arrays; t in s from the first sample."""

    t: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    effort: np.ndarray


def track(messages):
    stamps = [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in messages]
    return Track(
        np.array([s - stamps[0] for s in stamps]) * 1e-9,
        np.array([m.position[0] for m in messages]),
        np.array([m.velocity[0] for m in messages]),
        np.array([m.effort[0] for m in messages]),
    )


def since_reset(peer, states, seconds, rate):
    """Reset the simulator, collect a while, and return the messages from the reset on."""
    peer.more(states)
    before = len(states)
    assert peer.call(Trigger, 'pam_sim/reset').success
    found = peer.until(
        lambda: [i for i in range(before, len(states)) if states[i].position[0] == 0.0],
        'the initial state',
    )
    peer.until(lambda: len(states) >= found[0] + seconds * rate, f'{seconds} s of states')
    return states[found[0] :]


# The integrator is of fourth order: four times the rate, 256 times the accuracy.
@pytest.mark.parametrize(('physics_rate', 'tolerance'), [(1000.0, 2e-9), (4000.0, 1e-11)])
def test_released_load_moves_as_the_adaptive_solver_says(peer, physics_rate, tolerance):
    states = peer.collect(JointState, 'joint_states')
    with Program('pam_sim', parameters={**RELEASED, 'physics_rate': physics_rate}):
        got = track(since_reset(peer, states, 3, 500))
    np.testing.assert_allclose(np.diff(got.t), 2e-3, atol=1.1e-9)  # stamps are whole ns
    y, v = solve(600e3, 0.0, 0.0, got.t)
    assert np.max(np.abs(got.position - y)) < tolerance
    assert np.max(np.abs(got.velocity - v)) < 100.0 * tolerance
    assert np.max(np.abs(got.position)) > 0.05  # it did move
    forces = [spring(600e3, position)[0] for position in got.position]
    np.testing.assert_allclose(got.effort, forces, rtol=1e-12, atol=1e-9)


def are_as(a, b):
    return np.isclose(a, b, rtol=1e-10, atol=0.0)


def hears(peer, messages, wanted):
    """Wait for the values *wanted* (n,) among unstamped messages: they must be in one piece."""
    # Topics are not discovered in one moment: what came before is no measure of what is to come.
    peer.until(lambda: any(are_as([m.data for m in messages], wanted[-1])), f'{wanted[-1]}')
    values, n = np.array([m.data for m in messages]), len(wanted)
    assert any(np.all(are_as(values[i : i + n], wanted)) for i in range(len(values) - n + 1))


def test_force_stiffness_and_damping_are_those_of_the_state(peer):
    states = peer.collect(JointState, 'joint_states')
    topics = {name: peer.collect(Float64, name) for name in ('force', 'stiffness', 'damping')}
    with Program('pam_sim', parameters=RELEASED):
        for messages in topics.values():
            peer.more(messages)  # all are heard before the reset
        got = track(since_reset(peer, states, 1, 500))
        force, k = np.array([spring(600e3, y) for y in got.position]).T
        hears(peer, topics['force'], force)
        hears(peer, topics['stiffness'], k)
        hears(peer, topics['damping'], 2.0 * ZETA * np.sqrt(MASS * k))


def test_commands_act_where_the_pressure_says_they_did(peer):
    rate = 1000
    states = peer.collect(JointState, 'joint_states')
    pressures = peer.collect(FluidPressure, 'pressure')
    given = {'publish_rate': float(rate), 'command_timeout': 0.0, **lose_nothing()}
    with Program('pam_sim', parameters=given):
        for messages in (pressures, states):  # both are heard before the first command
            peer.more(messages, 50)
        for command in (300e3, 500e3, 450e3):
            peer.publish(Float64(data=command), 'pressure_command')
            peer.more(states, rate // 2)
    stamp = {(m.header.stamp.sec, m.header.stamp.nanosec): m for m in pressures}
    both = [m for m in states if (m.header.stamp.sec, m.header.stamp.nanosec) in stamp]
    got = track(both)
    p = np.array([stamp[m.header.stamp.sec, m.header.stamp.nanosec].fluid_pressure for m in both])
    p -= AMBIENT
    np.testing.assert_allclose(np.unique(p.round(3)), [0.0, 300e3, 450e3, 500e3])
    # A sample is the state before a command of the same stamp acts: a command acts at the last
    # sample that still has the old pressure.
    edges = [0, *np.flatnonzero(np.diff(p)), len(p) - 1]
    assert len(edges) == 5
    y, v = got.position[0], got.velocity[0]
    for a, b in pairwise(edges):
        path = solve(p[a + 1], y, v, got.t[a : b + 1])
        assert np.max(np.abs(got.position[a : b + 1] - path[0])) < 2e-9
        y, v = path[:, -1]
    assert got.position.max() > 0.08
