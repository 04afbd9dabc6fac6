# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The reservoir from which the muscles fill, with and without a lag of the chambers."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from pam_ros.effects import PressureLag, Supply
from pam_ros.rig.run import simulate, simulate_held
from support import bench, joint_models

FILL, VENT = 0.05, 0.07
LEVEL, SHARE, RECOVERY = 5e5, 0.2, 0.8
SUPPLY = Supply(share=SHARE, level=LEVEL, recovery=RECOVERY)
LAG = PressureLag(fill=FILL, vent=VENT)


def pressures_of(effects, commands, t, first=(1e5, 1e5), load=(SUPPLY,)):
    """Return the pressures (n, 2) of a pair that is commanded from its rest at *first* Pa."""
    rig = joint_models.pair(effects=(effects, effects), load=load)
    return simulate(rig, t, [first, commands], [0.0, 1e-9], position=0.1).pressure


def of_differential_equations(commands, t, first=(1e5, 1e5)):
    """Return the pressures (n, 2) of the chambers, from the balance of the air."""

    def rates(_, state):
        p, supply = state[:2], state[2]
        wanted = np.minimum(commands, supply)
        change = (wanted - p) / np.where(wanted >= p, FILL, VENT)
        fed = (change > 0.0) | (np.asarray(commands) >= supply)
        return [*change, (LEVEL - supply) / RECOVERY - SHARE * change[fed].sum()]

    run = solve_ivp(
        rates, (0.0, t[-1]), (*first, LEVEL), 'RK45', t, rtol=1e-9, atol=1e-3, max_step=1e-3
    )
    return run.y[:2].T


def balance(commands, first, supply=LEVEL):
    """Return the pressure at which chambers that fill at once are in balance with the supply."""

    def missing(limit):
        rises = np.minimum(commands, limit) - np.asarray(first)
        fed = (rises > 0.0) | (np.asarray(commands) >= limit)
        return limit - supply + SHARE * rises[fed].sum()

    return brentq(missing, 0.0, supply, xtol=1e-7)


@pytest.mark.parametrize('commands', [(4e5, 4e5), (4e5, 0.5e5)])
def test_below_the_pressure_of_the_supply_the_chambers_have_their_lag_alone(commands):
    t = np.linspace(0.0, 1.5, 151)
    with_it, without = (pressures_of((LAG,), commands, t, load=load) for load in ((SUPPLY,), ()))
    np.testing.assert_allclose(with_it, without, rtol=1e-14)


@pytest.mark.parametrize('commands', [(5.5e5, 3e5), (6e5, 6e5), (5.2e5, 0.2e5)])
def test_chambers_that_want_more_than_the_supply_has_follow_the_balance_of_air(commands):
    """The limit of a step of 1 ms is the pressure in its middle."""
    t = np.linspace(0.0, 1.5, 151)
    found, wanted = pressures_of((LAG,), commands, t), of_differential_equations(commands, t)
    np.testing.assert_allclose(found, wanted, atol=60.0)
    assert np.abs(found - pressures_of((LAG,), commands, t, load=())).max() > 20e3


@pytest.mark.parametrize('commands', [(5.5e5, 3e5), (6e5, 6e5), (5.2e5, 0.2e5), (6e5, 4.2e5)])
def test_chambers_that_fill_at_once_share_what_the_reservoir_has(commands):
    t = np.array([0.0, 1e-9, 2e-9, 2.0 * RECOVERY])
    jumped = pressures_of((), commands, t)[2]
    np.testing.assert_allclose(jumped, np.minimum(commands, balance(commands, (1e5, 1e5))), 1e-8)


def test_the_reservoir_is_refilled_until_the_chambers_have_its_level():
    t = np.array([0.0, 2.0, 4.0, 20.0])
    later = pressures_of((), (6e5, 6e5), t)[1:, 0]
    # One vessel of the reservoir and both muscles, which is refilled through the reservoir.
    slower = RECOVERY * (1.0 + 2.0 * SHARE)
    start = balance((6e5, 6e5), (1e5, 1e5))
    np.testing.assert_allclose(
        later, LEVEL + (start - LEVEL) * np.exp(-t[1:] / slower), atol=100.0
    )


def test_the_error_of_chambers_that_fill_at_once_is_of_first_order():
    t = np.array([0.0, 1.0])
    slower = RECOVERY * (1.0 + 2.0 * SHARE)
    start = balance((6e5, 6e5), (1e5, 1e5))
    expected = LEVEL + (start - LEVEL) * np.exp(-1.0 / slower)
    rig, command = joint_models.pair(load=(SUPPLY,)), [(1e5, 1e5), (6e5, 6e5)]
    found = [
        simulate(rig, t, command, [0.0, 1e-9], position=0.1, step=step).pressure[1, 0]
        for step in (2e-3, 1e-3, 0.5e-3)
    ]
    errors = np.abs(np.array(found) - expected)
    assert errors[1] < 30.0
    np.testing.assert_allclose(errors[:-1] / errors[1:], 2.0, rtol=1e-2)


def test_air_of_a_connected_muscle_flows_back_while_another_one_fills():
    t = np.array([0.0, 30.0, 30.0 + 1e-9, 30.0 + 2e-9])
    rig = joint_models.pair(load=(SUPPLY,))
    command = [(1e5, 1e5), (6e5, 1e5), (6e5, 4e5)]
    p = simulate(rig, t, command, [0.0, 1e-9, 30.0], position=0.1).pressure
    np.testing.assert_allclose(p[1], [LEVEL, 1e5], rtol=1e-6)
    # 3e5 Pa more in the second, in a vessel that is the reservoir and the first muscle.
    sunk = LEVEL - SHARE * 3e5 / (1.0 + SHARE)
    np.testing.assert_allclose(p[3], [sunk, 4e5], rtol=1e-6)


def test_after_a_long_rest_no_muscle_has_more_than_the_level():
    rig = bench.hanging(Supply(share=SHARE, level=2e5, recovery=RECOVERY))
    run = simulate(rig, [0.0, 1.0], [3e5], [0.0])
    np.testing.assert_allclose(run.pressure, 2e5, rtol=1e-14)


def test_a_reservoir_that_begins_to_sag_takes_no_air_from_the_muscles_before():
    t = np.linspace(0.0, 3.0, 31)
    late = Supply(share=SHARE, level=2e5, recovery=RECOVERY, onset=1.0)
    command = [2e5, 3e5, 2e5, 3e5]
    p = simulate(bench.hanging(late), t, command, [0.0, 0.5, 1.4, 2.0]).pressure
    without = simulate(bench.hanging(), t, command, [0.0, 0.5, 1.4, 2.0]).pressure
    assert np.array_equal(p[:11], without[:11])
    np.testing.assert_allclose(p[15:20], 2e5, rtol=1e-3)


def test_measured_pressures_have_passed_the_supply():
    t = np.linspace(0.0, 1.0, 11)
    p, y = np.linspace(4e5, 1e5, 11), np.full(11, 0.03)
    behind = PressureLag(fill=FILL, vent=VENT)
    limited = simulate_held(bench.hanging(Supply(share=SHARE, level=2e5), behind), t, p, y)
    assert np.array_equal(limited.force, simulate_held(bench.hanging(behind), t, p, y).force)
