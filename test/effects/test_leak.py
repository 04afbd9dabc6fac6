# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The leak, open valve and closed, against closed forms."""

import numpy as np
import pytest

from pam_ros.effects import Leak
from pam_ros.rig.run import simulate
from support import bench


@pytest.mark.parametrize('step', [1e-3, 1e-2])
def test_open_valve_balances_leak_and_refill(step):
    rate, refill, u0, u1 = 0.4, 0.25, 2e4, 5e4
    t = np.linspace(0.0, 2.0, 201)
    model = bench.cart(Leak(rate=rate, refill=refill), mass=1e4)
    run = simulate(model, t, [u0, u1], [0.0, 0.5], position=0.0, step=step)
    share = 1.0 / (1.0 + rate * refill)
    after = np.maximum(t - 0.5, 0.0)
    expected = share * (u1 + (u0 - u1) * np.exp(-after * (1.0 / refill + rate)))
    np.testing.assert_allclose(run.pressure[1:], expected[1:], rtol=1e-12)
    assert run.pressure[0] == pytest.approx(share * u0)


@pytest.mark.parametrize('step', [1e-3, 1e-2])
def test_closed_valve_loses_pressure_until_the_command_changes(step):
    rate, u0, u1 = 0.1, 2e4, 6e4
    t = np.linspace(0.0, 4.0, 41)
    run = simulate(
        bench.cart(Leak(rate=rate), mass=1e4), t, [u0, u1], [0.0, 2.0], position=0.0, step=step
    )
    before, after = t <= 2.0, t > 2.0
    np.testing.assert_allclose(run.pressure[before], u0 * np.exp(-rate * t[before]), rtol=1e-12)
    # A change of 40 kPa is 20 times what gives back all but 1/e of the loss.
    np.testing.assert_allclose(
        run.pressure[after], u1 * np.exp(-rate * (t[after] - 2.0)), rtol=1e-7
    )


def test_small_change_gives_back_a_part_of_the_loss():
    rate, u0, du = 0.2, 2e4, 2e3
    t = np.array([0.0, 1.0, 1.5])
    leak = Leak(rate=rate)
    run = simulate(bench.cart(leak, mass=1e4), t, [u0, u0 + du], [0.0, 1.0], position=0.0)
    lost = u0 * (1.0 - np.exp(-rate))
    expected = (u0 + du - lost / np.e) * np.exp(-0.5 * rate)
    assert run.pressure[2] == pytest.approx(expected, rel=1e-12)


def test_load_sinks_with_the_pressure():
    rate = 0.05
    t = np.linspace(0.0, 3.0, 61)
    run = simulate(bench.hanging(Leak(rate=rate)), t, [4e5], [0.0])

    def rhs(s, state, u):
        y, v = state
        p = u * np.exp(-rate * s)
        return v, (bench.pull(p, y) - bench.drag(p, y) * v) / bench.MASS - bench.G

    y, _ = bench.solved(rhs, t, (bench.rest(4e5), 0.0), ((0.0, 4e5),))
    np.testing.assert_allclose(run.position, y, atol=1e-8)
    assert y[-1] < y[0] - 5e-3


@pytest.mark.parametrize('refill', [1e-300, 1e-9])
def test_a_refill_faster_than_any_leaves_no_loss_and_no_nan(refill):
    t = np.array([0.0, 0.5, 1.0])
    model = bench.cart(Leak(rate=0.5, refill=refill), mass=1e4)
    run = simulate(model, t, [100.0, 200.0], [0.0, 0.5], position=0.0)
    np.testing.assert_allclose(run.pressure, [100.0, 100.0, 200.0], rtol=1e-6)


@pytest.mark.parametrize('step', [1e-3, 1e-2])
@pytest.mark.parametrize('vent', [0.0, 0.03, 0.3])
def test_a_valve_fully_open_against_an_adaptive_solver(step, vent):
    rate, refill, supply = 0.8, 0.08, 4e5
    leak = Leak(rate=rate, refill=refill, supply=supply, vent=vent)
    t = np.linspace(0.0, 2.0, 201)
    commands = ((0.0, 1e5), (0.2, 4e5), (1.2, 0.5e5))
    model = bench.cart(leak, mass=1e4)
    run = simulate(model, t, **bench.stepped(commands), position=0.0, step=step)

    def rhs(_, state, u):
        p = state[0]
        out = (u - p) / max(vent, 1e-6)
        return ((min((u - p) / refill, supply) if p < u else out) - rate * p,)

    (p,) = bench.solved(rhs, t, (1e5 / (1.0 + rate * refill),), commands)
    # The solver's exhaust takes a microsecond where ours opens at once.
    np.testing.assert_allclose(run.pressure, p, rtol=1e-6 if vent else 2e-5)
    assert np.max(np.diff(run.pressure)) < 0.01 * supply


@pytest.mark.parametrize('step', [1e-3, 1e-2])
@pytest.mark.parametrize('vent', [0.0, 0.05])
def test_an_exhaust_of_limited_flow_against_an_adaptive_solver(step, vent):
    rate, refill, exhaust = 0.8, 0.08, 5e5
    leak = Leak(rate=rate, refill=refill, vent=vent, exhaust=exhaust)
    t = np.linspace(0.0, 1.5, 151)
    commands = ((0.0, 3e5), (0.2, 0.5e5), (1.0, 4e5), (1.1, 3.7e5))
    model = bench.cart(leak, mass=1e4)
    run = simulate(model, t, **bench.stepped(commands), position=0.0, step=step)

    def rhs(_, state, u):
        p = state[0]
        out = max((u - p) / max(vent, 1e-5), -exhaust)
        return ((out if p > u else (u - p) / refill) - rate * p,)

    (p,) = bench.solved(rhs, t, (3e5 / (1.0 + rate * refill),), commands)
    np.testing.assert_allclose(run.pressure, p, rtol=1e-6 if vent else 1e-4)
    assert np.min(np.diff(run.pressure)) > -0.01 * (exhaust + rate * 3e5)


@pytest.mark.parametrize('rate', [1e-4, 1e-8, 1e-12])
def test_a_valve_fully_open_fills_hardly_slower_for_a_hair_of_a_leak(rate):
    t = np.array([0.0, 0.1, 0.2, 0.3])
    leak = {'rate': rate, 'refill': 1e-6, 'supply': 1e6}
    run = simulate(bench.cart(Leak(**leak), mass=1e4), t, [1e5, 9e5], [0.0, 0.1], position=0.0)
    np.testing.assert_allclose(run.pressure, [1e5, 1e5, 2e5, 3e5], rtol=rate + 1e-12)


@pytest.mark.parametrize('rate', [5e-324, 1e-300, 1e-13])
def test_a_leak_of_ages_is_none(rate):
    t = np.array([0.0, 0.1, 0.2])
    leak = {'rate': rate, 'refill': 1e-3, 'supply': 1e9, 'vent': 0.1}
    run = simulate(bench.cart(Leak(**leak), mass=1e4), t, [1e5, 9e5], [0.0, 0.1], position=0.0)
    np.testing.assert_array_equal(run.pressure, [1e5, 1e5, 9e5])


def test_a_pressure_far_below_zero_is_not_reached_with_the_valve_fully_open():
    """A fit may try such a pressure before the valve: the loss ends where the flow is balanced."""
    rate, exhaust, first, p = 2.0, 1e3, 1e5, -5e4
    rig = bench.hanging(Leak(rate=rate, refill=0.05, vent=0.0, exhaust=exhaust))
    q, layout = rig.parameters()[1], rig.layout
    j, i = layout.parameter_at['leak'], layout.state_at['leak']
    x, xn = layout.state()[1], layout.scratch()[1]
    x[i], x[i + 1] = first, first
    for h in (0.0, 0.1, 1.0, 10.0):
        expected = (first + exhaust / rate) * np.exp(-rate * h) - exhaust / rate
        found = Leak.equations.pressure(p, h, h, x, i, xn, q, j)
        assert found == pytest.approx(expected, rel=1e-12)
