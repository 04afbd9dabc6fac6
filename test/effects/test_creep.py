# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Creep against its exponentials at held length, and an adaptive solver under load."""

import numpy as np
import pytest
from scipy.integrate import trapezoid

from pam_ros.effects import Creep
from pam_ros.rig.run import simulate, simulate_held
from support import bench

TIME, SPREAD = 2.0, 3.0


def late(after, balance=0.5):
    """Return the part of a unit step that is still to come, after so many seconds."""
    fast, slow = np.exp(-after * SPREAD / TIME), np.exp(-after / (TIME * SPREAD))
    return (1.0 - balance) * fast + balance * slow


@pytest.mark.parametrize('share', [0.06, -0.04])
@pytest.mark.parametrize('balance', [0.5, 0.2])
@pytest.mark.parametrize('of', ['force', 'pressure'])
def test_force_at_held_length_creeps_after_a_step_of_pressure(of, balance, share):
    # The pull is affine in the pressure: a share of either is the same share of the step.
    creep = Creep(**{of: share}, time=TIME, spread=SPREAD, balance=balance)
    t = np.concatenate([[0.0, 1.0], 1.0 + 1e-9 + np.linspace(0.0, 20.0, 201)])
    p = np.where(t > 1.0, 4e5, 2e5)
    run = simulate_held(bench.hanging(creep), t, p, np.full(t.size, 0.03))
    low, high = bench.pull(2e5, 0.03), bench.pull(4e5, 0.03)
    expected = np.where(t > 1.0, high - share * (high - low) * late(t - 1.0, balance), low)
    np.testing.assert_allclose(run.force, expected, rtol=1e-8)


@pytest.mark.parametrize('step', [1e-3, 0.1])
def test_pull_relaxes_after_a_ramp_of_length_at_any_step(step):
    stiffness, speed = 800.0, 0.02
    creep = Creep(stiffness=stiffness, time=TIME)
    t = np.linspace(0.0, 10.0, 101)
    y = 0.03 + speed * np.minimum(t, 1.0)
    run = simulate_held(bench.hanging(creep), t, np.full(t.size, 3e5), y, 0 * t, step)
    # A ramp of rate r leaves r T (1 - exp(-t/T)) behind; it fades after its end.
    rate = speed / bench.L0
    behind = rate * TIME * (np.exp(-np.maximum(t - 1.0, 0.0) / TIME) - np.exp(-t / TIME))
    expected = [bench.pull(3e5, a) for a in y] - stiffness * behind
    np.testing.assert_allclose(run.force, expected, rtol=1e-11)


def test_load_creeps_up_after_a_step_of_pressure():
    stiffness = 900.0
    creep = Creep(force=0.05, stiffness=stiffness, time=TIME, spread=SPREAD)
    t = np.linspace(0.0, 8.0, 161)
    commands = ((0.0, 2e5), (0.5, 3e5))
    run = simulate(bench.hanging(creep), t, **bench.stepped(commands))
    fast, slow = TIME / SPREAD, TIME * SPREAD

    def rhs(_, state, u):
        y, v, f_fast, f_slow, k_fast, k_slow = state
        f, kappa = bench.pull(u, y), y / bench.L0
        net = f - 0.05 * (f - 0.5 * (f_fast + f_slow))
        net -= stiffness * (kappa - 0.5 * (k_fast + k_slow))
        return (
            v,
            (net - bench.drag(u, y) * v) / bench.MASS - bench.G,
            (f - f_fast) / fast,
            (f - f_slow) / slow,
            (kappa - k_fast) / fast,
            (kappa - k_slow) / slow,
        )

    y0 = bench.rest(2e5)
    f0, kappa0 = bench.pull(2e5, y0), y0 / bench.L0
    y, *_ = bench.solved(rhs, t, (y0, 0.0, f0, f0, kappa0, kappa0), commands)
    # In the one step where the command jumps, the force's jump is taken for a ramp.
    np.testing.assert_allclose(run.position, y, atol=1e-6)
    assert y[-1] - y[40] > 1e-3


def test_work_over_closed_loops_is_never_gained():
    creep = Creep(stiffness=900.0, time=0.5)
    for period in (0.1, 1.0, 10.0):
        t = np.linspace(0.0, 10.0 * period, 4001)
        y = 0.05 + 0.02 * np.sin(2.0 * np.pi * t / period)
        p, still = np.full(t.size, 3e5), np.zeros(t.size)
        force = simulate_held(bench.hanging(creep), t, p, y, still).force
        last = t >= 9.0 * period - 1e-9
        assert trapezoid(force[last], y[last]) < 0.0
