# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Viscous friction against the exponential of a coasting load and its final speed."""

import numpy as np
import pytest

from pam_ros.effects import PressureDependentDamping, ViscousFriction
from pam_ros.errors import ParameterError
from pam_ros.rig.run import simulate, simulate_held
from pam_ros.rig.step_limit import longest_step
from support import bench

C = 40.0
EFFECT = [ViscousFriction(coefficient=C)]


def test_coasting_load_loses_its_speed_exponentially():
    t = np.linspace(0.0, 1.0, 101)
    run = simulate(bench.cart(*EFFECT), t, [0.0], [0.0], position=0.0, velocity=0.3)
    np.testing.assert_allclose(run.velocity, 0.3 * np.exp(-C / bench.MASS * t), rtol=1e-10)


def test_driven_load_reaches_force_over_coefficient():
    run = simulate(bench.cart(*EFFECT), [0.0, 8.0], [20.0], [0.0], position=0.0)
    np.testing.assert_allclose(run.velocity[1], 20.0 / C, rtol=1e-12)


def test_swinging_load_against_an_adaptive_solver():
    t = np.linspace(0.0, 1.0, 101)
    y0 = bench.rest(3e5) + 0.01
    run = simulate(bench.hanging(*EFFECT), t, [3e5], [0.0], position=y0)

    def rhs(_, state, u):
        y, v = state
        return v, (bench.pull(u, y) - (bench.drag(u, y) + C) * v) / bench.MASS - bench.G

    y, _ = bench.solved(rhs, t, (y0, 0.0), ((0.0, 3e5),))
    np.testing.assert_allclose(run.position, y, atol=1e-9)


def test_a_machine_that_moves_the_actuator_feels_it():
    t = np.linspace(0.0, 1.0, 11)
    p, y = np.full(11, 3e5), 0.02 + 0.03 * t
    with_friction = simulate_held(bench.hanging(*EFFECT), t, p, y).force
    without = simulate_held(bench.hanging(), t, p, y).force
    np.testing.assert_allclose(with_friction, without - C * 0.03, rtol=1e-12)


@pytest.mark.parametrize(
    'effect',
    [
        [ViscousFriction(coefficient=1e4)],
        [PressureDependentDamping(deflating=0.05)],
    ],
    ids=['viscous', 'by pressure'],
)
def test_drag_that_the_step_cannot_resolve_is_refused(effect):
    with pytest.raises(ParameterError, match=r'with a drag of .* N s/m: give at least'):
        simulate(bench.hanging(*effect, mass=2.0), [0.0, 0.1], [3e5], [0.0])


def test_drag_up_to_that_is_stepped_as_it_is():
    model = bench.cart(ViscousFriction(coefficient=400.0), mass=0.5)
    assert longest_step(model) == pytest.approx(0.5 / 400.0)
    run = simulate(model, [0.0, 0.1], [20.0], [0.0], position=0.0)
    np.testing.assert_allclose(run.velocity[1], 20.0 / 400.0, rtol=1e-9)
