# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The pressure lag against its exponentials, and against an adaptive solver with the load."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import PressureLag
from pam_ros.rig.run import simulate
from support import bench

FILL, VENT = 0.08, 0.2
EFFECT = [PressureLag(fill=FILL, vent=VENT)]
COMMANDS = ((0.0, 2e5), (0.1, 4e5), (0.4, 1e5), (0.4137, 3e5), (0.7, 2.5e5))


def chamber(t):
    """Return the pressure at t, from one command to the next."""
    p = COMMANDS[0][1]
    for k, (stamp, u) in enumerate(COMMANDS):
        end = COMMANDS[k + 1][0] if k + 1 < len(COMMANDS) else np.inf
        tau = FILL if u > p else VENT
        if t <= end:
            return u + (p - u) * np.exp(-max(t - stamp, 0.0) / tau)
        p = u + (p - u) * np.exp(-(end - stamp) / tau)
    return p


@pytest.mark.parametrize('step', [1e-3, 1e-2])
def test_fills_and_vents_exponentially_at_any_step(step):
    t = np.linspace(0.0, 1.0, 101)
    model = bench.cart(*EFFECT, mass=1e4)
    run = simulate(model, t, **bench.stepped(COMMANDS), position=0.0, step=step)
    np.testing.assert_allclose(run.pressure, [chamber(a) for a in t], rtol=1e-12)


def test_load_follows_the_lagging_pressure():
    t = np.linspace(0.0, 1.0, 101)
    run = simulate(bench.hanging(*EFFECT), t, **bench.stepped(COMMANDS))

    def rhs(s, state, u):
        y, v, p = state
        dp = (u - p) / (FILL if u > p else VENT)
        return v, (bench.pull(p, y) - bench.drag(p, y) * v) / bench.MASS - bench.G, dp

    y, _, p = bench.solved(rhs, t, (bench.rest(2e5), 0.0, 2e5), COMMANDS)
    np.testing.assert_allclose(run.pressure, p, rtol=1e-8)
    np.testing.assert_allclose(run.position, y, atol=1e-8)


@pytest.mark.parametrize(('step', 'atol'), [(1e-3, 1e-8), (5e-3, 5e-7)])
@pytest.mark.parametrize(('fill', 'vent'), [(FILL, 0.0), (0.0, VENT)])
def test_load_follows_a_pressure_that_jumps_in_one_direction(fill, vent, step, atol):
    t = np.linspace(0.0, 1.0, 101)
    effect = PressureLag(fill=fill, vent=vent)
    run = simulate(bench.hanging(effect), t, **bench.stepped(COMMANDS), step=step)

    def rhs(s, state, u):
        y, v, p = state
        dp = (u - p) / (fill or vent)
        return v, (bench.pull(p, y) - bench.drag(p, y) * v) / bench.MASS - bench.G, dp

    state = np.array([bench.rest(2e5), 0.0, 2e5])
    ends = [*(stamp for stamp, _ in COMMANDS[1:]), t[-1]]
    for (stamp, u), end in zip(COMMANDS, ends, strict=True):
        if (fill if u > state[2] else vent) == 0.0:
            state[2] = u
        inside = (t > stamp) & (t <= end)
        out = bench.solved(rhs, [stamp, *t[inside], end], state, [(stamp, u)])
        np.testing.assert_allclose(run.position[inside], out[0, 1:-1], atol=atol)
        state = out[:, -1]


def test_a_valve_with_a_dead_zone_stops_at_its_edge():
    # The edges of the zone, 10 kPa from the command, are what the exponentials approach.
    t = np.linspace(0.0, 3.0, 301)
    model = bench.cart(PressureLag(fill=FILL, vent=VENT, dead_zone=1e4), mass=1e4)
    commands = ((0.0, 2e5), (0.1, 2.05e5), (0.2, 4e5), (1.0, 3.85e5), (1.5, 1e5))
    run = simulate(model, t, **bench.stepped(commands), position=0.0)
    filling = 3.9e5 - 1.9e5 * np.exp(-np.maximum(t - 0.2, 0.0) / FILL)
    full = 3.9e5 - 1.9e5 * np.exp(-0.8 / FILL)
    venting = 1.1e5 + (full - 1.1e5) * np.exp(-np.maximum(t - 1.5, 0.0) / VENT)
    # The commands of 0.1 and 1.0 s are within the zone: the valve stays closed.
    expected = np.select([t < 0.2, t < 1.0, t < 1.5], [2e5, filling, full], venting)
    np.testing.assert_allclose(run.pressure, expected, rtol=1e-9)


def test_a_dead_zone_without_a_lag_is_a_play_of_the_command():
    # Prandtl's play, sample by sample from its definition.
    t = np.arange(0.0, 2.0, 1e-2)
    u = 3e5 + 3e4 * np.sin(9.0 * t) * t + 4e3 * np.sin(40.0 * t)
    play = [u[0]]
    for one in u:
        play.append(float(np.clip(play[-1], one - 5e3, one + 5e3)))
    model = bench.cart(PressureLag(dead_zone=5e3), mass=1e4)
    run = simulate(model, t, u, position=0.0)
    np.testing.assert_allclose(run.pressure[1:], play[1:-1], rtol=1e-12)


def test_load_follows_a_valve_with_a_dead_zone():
    t = np.linspace(0.0, 1.0, 101)
    run = simulate(bench.hanging(replace(EFFECT[0], dead_zone=2e4)), t, **bench.stepped(COMMANDS))

    def rhs(s, state, u):
        y, v, p = state
        dp = max(u - 2e4 - p, 0.0) / FILL + min(u + 2e4 - p, 0.0) / VENT
        return v, (bench.pull(p, y) - bench.drag(p, y) * v) / bench.MASS - bench.G, dp

    y, _, p = bench.solved(rhs, t, (bench.rest(2e5), 0.0, 2e5), COMMANDS)
    np.testing.assert_allclose(run.pressure, p, rtol=1e-8)
    np.testing.assert_allclose(run.position, y, atol=1e-8)


def test_filling_or_venting_may_be_immediate():
    t = np.array([0.0, 0.1, 0.2, 0.3])
    model = bench.cart(PressureLag(vent=0.1))
    run = simulate(model, t, [100.0, 300.0, 100.0], [0.0, 0.05, 0.2], position=0.0)
    np.testing.assert_allclose(run.pressure, [100.0, 300.0, 300.0, 100.0 + 200.0 / np.e])


@pytest.mark.parametrize('tau', [0.08, 0.0])
def test_choked_flow_limits_the_slope(tau):
    # 200 kPa at 5e5 Pa/s: straight until the difference is down to 5e5 tau, then exponential.
    fastest = 5e5
    model = bench.cart(PressureLag(fill=tau, vent=0.05, fastest=fastest), mass=1e4)
    t = np.linspace(0.0, 0.8, 161)
    run = simulate(model, t, [3e5], [0.0], position=0.0)
    assert run.pressure[0] == pytest.approx(3e5)
    run = simulate(model, t, [1e5, 3e5], [0.0, 0.1], position=0.0)
    straight = (2e5 - fastest * tau) / fastest
    after = t - 0.1
    tail = fastest * tau * np.exp(-np.maximum(after - straight, 0.0) / tau) if tau else 0.0 * t
    expected = np.where(after < straight, 1e5 + fastest * np.maximum(after, 0.0), 3e5 - tail)
    np.testing.assert_allclose(run.pressure, expected, rtol=1e-9)
    vented = simulate(model, t, [3e5, 1e5], [0.0, 0.1], position=0.0).pressure
    np.testing.assert_allclose(vented, 1e5 + 2e5 * np.exp(-np.maximum(after, 0.0) / 0.05))
    limits = {'fill': 0.01, 'vent': 0.05, 'fastest_vent': 1e6}
    slower = simulate(
        bench.cart(PressureLag(**limits), mass=1e4), t, [3e5, 1e5], [0.0, 0.1], position=0.0
    ).pressure
    # 150 kPa straight at 1e6 Pa/s, the last 50 kPa exponentially.
    straight = np.clip(3e5 - 1e6 * np.maximum(after, 0.0), 1.5e5, 3e5)
    tail = 1e5 + 5e4 * np.exp(-np.maximum(after - 0.15, 0.0) / 0.05)
    np.testing.assert_allclose(slower, np.where(after < 0.15, straight, tail), rtol=1e-9)


def iso_6358(up, down):
    """Return the mass flow, relative, through an orifice of critical ratio 0.35; absolute Pa."""
    ratio = (down / up - 0.35) / 0.65
    return up * np.sqrt(1.0 - np.clip(ratio, 0.0, 1.0) ** 2)


def test_orifices_choke_as_iso_6358_says():
    given = {'fill': 0.06, 'vent': 0.09, 'fastest': 1.5e6, 'choking': 1.0, 'supply': 7e5}
    t = np.linspace(0.0, 1.5, 301)
    commands = ((0.0, 1e5), (0.1, 6.5e5), (0.7, 0.2e5))
    air, at = 1.013e5, 3e5 + 1.013e5

    def rhs(_, state, u):
        p = state[0]
        if u > p:
            g = iso_6358(7e5 + air, p + air) / iso_6358(7e5 + air, at)
            return (g * min((u - p) / 0.06, 1.5e6),)
        return (iso_6358(p + air, air) / iso_6358(at, air) * (u - p) / 0.09,)

    (p,) = bench.solved(rhs, t, (1e5,), commands)
    errors = []
    for step in (4e-3, 2e-3, 1e-3):
        model = bench.cart(PressureLag(**given), mass=1e4)
        run = simulate(model, t, **bench.stepped(commands), position=0.0, step=step)
        errors.append(np.max(np.abs(run.pressure - p)))
    # Of second order but in the step in which the valve begins to close.
    assert errors[0] < 20.0
    assert errors[0] > 2.0 * errors[1] > 4.0 * errors[2]
    # An orifice that does not care about the pressures is the plain lag.
    plain = simulate(bench.cart(PressureLag(**given | {'choking': 0.0}), mass=1e4), t, [1e5, 2e5],
                     [0.0, 0.1], position=0.0).pressure  # fmt: skip
    after = np.maximum(t - 0.1, 0.0)
    straight = (1e5 - 1.5e6 * 0.06) / 1.5e6
    slow = 1e5 + 1.5e6 * after
    tail = 2e5 - 0.9e5 * np.exp(-np.maximum(after - straight, 0.0) / 0.06)
    np.testing.assert_allclose(plain, np.where(after < straight, slow, tail), rtol=1e-9)
