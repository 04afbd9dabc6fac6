# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Damping that grows with pressure, against exponentials and an adaptive solver."""

import numpy as np
import pytest

from pam_ros.effects import PressureDependentDamping
from pam_ros.rig.run import simulate, simulate_held
from support import bench

UP, DOWN = 4e-4, 1e-4  # N s/(m Pa): 40 and 10 N s/m per bar
EFFECT = [PressureDependentDamping(inflating=UP, deflating=DOWN)]


@pytest.mark.parametrize(('v0', 'b'), [(0.2, 0.1), (-0.2, 0.05)])
def test_speed_approaches_its_end_at_the_rate_of_its_direction(v0, b):
    # A cart, drawn with p in N against b p v: it ends at 1/b, whatever the pressure.
    t = np.linspace(0.0, 0.2, 21)
    m, p = 1e3, 50.0
    model = bench.cart(PressureDependentDamping(inflating=0.1, deflating=0.05), mass=m)
    run = simulate(model, t, [p], [0.0], position=0.0, velocity=v0)
    expected = 1.0 / b + (v0 - 1.0 / b) * np.exp(-b * p / m * t)
    np.testing.assert_allclose(run.velocity, expected, rtol=1e-12)


def test_swinging_load_against_an_adaptive_solver():
    t = np.linspace(0.0, 1.0, 101)
    y0 = bench.rest(3e5) + 0.01
    run = simulate(bench.hanging(*EFFECT), t, [3e5], [0.0], position=y0)

    def rhs(_, state, u):
        y, v = state
        c = bench.drag(u, y) + (UP if v > 0.0 else DOWN) * u
        return v, (bench.pull(u, y) - c * v) / bench.MASS - bench.G

    y, _ = bench.solved(rhs, t, (y0, 0.0), ((0.0, 3e5),), max_step=1e-3)
    np.testing.assert_allclose(run.position, y, atol=1e-7)  # kink of the force at v = 0


@pytest.mark.parametrize(('speed', 'b'), [(0.05, UP), (-0.05, DOWN)])
def test_force_cell_of_a_moved_muscle_feels_it(speed, b):
    t = np.linspace(0.0, 1.0, 11)
    p, y = np.full(11, 3e5), 0.06 + speed * (t - 0.5)
    less = (
        simulate_held(bench.hanging(), t, p, y).force
        - simulate_held(bench.hanging(*EFFECT), t, p, y).force
    )
    np.testing.assert_allclose(less, b * 3e5 * speed, rtol=1e-9)


def test_a_vacuum_does_not_drive():
    t = np.array([0.0, 1.0])
    model = bench.cart(PressureDependentDamping(inflating=0.1, deflating=0.1))
    run = simulate(model, t, [-20.0], [0.0], position=0.0, velocity=0.0)
    assert run.velocity[1] == pytest.approx(-2.0)
