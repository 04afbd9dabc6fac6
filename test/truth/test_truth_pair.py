# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The truth plant that turns, against DOP853 on equations in the muscles' own units."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from support import joints, paper
from truth.effects import effect
from truth.muscles import GRAVITY
from truth.pair import PAIR_PLANTS, TruthPair, pair_plant
from truth.reservoir import Reservoir

BAR = 1e5
# The moment of gravity of ``support.joints``, which falls a little slower, and the same inertia.
MASS = joints.M * paper.G / GRAVITY
SAME = {
    'muscles': ('dmsp_20_400n', 'dmsp_20_200n'),
    'lengths': (0.4, 0.2),
    'radius': joints.R,
    'inertia': joints.J - MASS * joints.ARM**2,
    'mass': MASS,
    'arm': joints.ARM,
    'hanging_at': joints.HANGING_AT,
    'contraction': (joints.KAPPA_1, joints.KAPPA_2),
}
STRANDS = (joints.LONG, joints.SHORT)


@pytest.mark.parametrize('zeta', [0.0, 0.15])
def test_a_step_of_both_pressures_matches_dop853(zeta):
    plant = TruthPair(**SAME, zeta=zeta)
    plant.reset(0.1, (3e5, 3e5))
    p = (4.0, 2.5)
    t = np.linspace(0.002, 1.0, 500)
    found = solve_ivp(
        joints.pair(lambda _: p, STRANDS, zeta),
        (0.0, 1.0),
        (0.1, 0.0),
        'DOP853',
        t,
        rtol=1e-11,
        atol=1e-13,
    )
    assert np.ptp(found.y[0]) > 0.05
    rows = []
    for _ in t:
        plant.step((p[0] * BAR, p[1] * BAR), 0.002)
        rows.append((plant.angle, plant.rate))
    np.testing.assert_allclose(np.array(rows).T[0], found.y[0], atol=1e-6)
    np.testing.assert_allclose(np.array(rows).T[1], found.y[1], atol=5e-5)


def test_its_stiffness_is_that_of_the_equations():
    plant = TruthPair(**SAME)
    plant.reset(0.2, (4e5, 2e5))
    y = joints.ends(0.2, STRANDS)
    expected = joints.R**2 * (joints.LONG.stiffness(4.0, y[0]) + joints.SHORT.stiffness(2.0, y[1]))
    assert plant.stiffness() == pytest.approx(expected, rel=1e-6)


def test_friction_holds_forces_up_to_its_breakaway():
    plant = pair_plant('friction', noise=0.0)
    plant.reset(0.0, (3e5, 3e5))
    # 0.15 N m off balance on 29 N m/rad: stuck, but for the bend of the bristles.
    for _ in range(1000):
        plant.step((3.005e5, 2.995e5), 2e-3)
    free = pair_plant('nominal', noise=0.0)
    free.reset(0.0, (3e5, 3e5))
    for _ in range(1000):
        free.step((3.005e5, 2.995e5), 2e-3)
    assert abs(plant.angle) < 0.3 * abs(free.angle)


def test_the_chambers_lag():
    plant = pair_plant('lag', noise=0.0)
    plant.reset(0.0, (2e5, 2e5))
    plant.step((3e5, 1e5), 0.05)
    fill, vent = plant.pressures
    assert fill == pytest.approx(3e5 - 1e5 * math.exp(-0.05 / 0.05), rel=1e-9)
    assert vent == pytest.approx(1e5 + 1e5 * math.exp(-0.05 / 0.07), rel=1e-9)


FILL, VENT = 0.05, 0.07
LAG = effect('pressure_lag', 'two_times', fill_s=FILL, vent_s=VENT)


def from_reservoir(reservoir, commands, seconds):
    """Return times, both pressures and that of the reservoir, of its differential equations."""

    def rates(_, state):
        p, supply = state[:2], state[2]
        wanted = np.minimum(commands, supply)
        change = (wanted - p) / np.where(wanted >= p, FILL, VENT)
        fed = (change > 0.0) | (np.asarray(commands) >= supply)
        back = (reservoir.level - supply) / reservoir.recovery
        return [*change, back - reservoir.share * change[fed].sum()]

    t = np.linspace(0.002, seconds, round(seconds / 0.002))
    start = (1e5, 1e5, reservoir.level)
    found = solve_ivp(rates, (0.0, seconds), start, 'RK45', t, rtol=1e-9, atol=1e-3, max_step=1e-3)
    return t, found.y[:2], found.y[2]


@pytest.mark.parametrize('commands', [(4e5, 4e5), (4e5, 0.5e5), (5.5e5, 3e5)])
def test_a_reservoir_falls_while_the_muscles_fill(commands):
    reservoir = Reservoir(level=5e5, share=0.2, recovery=0.8)
    t, pressures, supply = from_reservoir(reservoir, commands, 1.5)
    assert supply.min() < 0.95 * reservoir.level
    plant = TruthPair(in_muscles=(LAG,), reservoir=reservoir)
    plant.reset(0.0, (1e5, 1e5))
    rows = []
    for _ in t:
        plant.step(commands, 0.002)
        rows.append((*plant.pressures, plant.state.supply))
    np.testing.assert_allclose(np.transpose(rows), [*pressures, supply], atol=60.0)


def test_a_large_reservoir_is_no_reservoir():
    ends = []
    for reservoir in (None, Reservoir(level=6e5, share=0.0, recovery=1.0)):
        plant = TruthPair(in_muscles=(LAG,), reservoir=reservoir)
        plant.reset(0.0, (3e5, 3e5))
        ends.append([plant.step((4e5, 2e5), 2e-3) for _ in range(100)])
    assert ends[0] == ends[1]


def test_both_muscles_together_fill_more_slowly_than_one_alone():
    reached = []
    for other in (1e5, 4e5):
        plant = TruthPair(in_muscles=(LAG,), reservoir=Reservoir(4.5e5, share=0.3, recovery=5.0))
        plant.reset(0.0, (1e5, 1e5))
        plant.step((4e5, other), 0.1)
        reached.append(plant.pressures[0])
    assert reached[1] < reached[0] - 10e3


@pytest.mark.parametrize('name', PAIR_PLANTS)
def test_the_same_seed_is_the_same_run(name):
    ends = []
    for _ in range(2):
        plant = pair_plant(name, seed=4)
        plant.reset(0.0, (3e5, 2e5))
        ends.append([plant.step((3e5, 2.5e5), 2e-3) for _ in range(50)])
    assert ends[0] == ends[1]
