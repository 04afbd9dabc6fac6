# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sinusoids against closed forms, and the guess of their frequency from a residual."""

import numpy as np
import pytest

from pam_ros.effects import PeriodicDisturbance
from pam_ros.rig.run import simulate, simulate_held
from support import bench

OMEGA = 2.0 * np.pi * 3.7


def test_force_shakes_a_free_load():
    a, b, m = 4.0, -3.0, bench.MASS
    effect = {'force_sin': a, 'force_cos': b, 'frequency': 3.7}
    t = np.linspace(0.0, 2.0, 201)
    run = simulate(bench.cart(PeriodicDisturbance(**effect)), t, [0.0], [0.0], position=0.0)
    s, c = np.sin(OMEGA * t), np.cos(OMEGA * t)
    y = (a * (OMEGA * t - s) + b * (1.0 - c)) / (m * OMEGA**2)
    np.testing.assert_allclose(run.position, y, atol=1e-10)


def test_ripple_is_in_the_chamber_and_in_the_held_force():
    a, b = 3e3, 1e3
    effect = {'pressure_sin': a, 'pressure_cos': b, 'frequency': 3.7}
    t = np.linspace(0.0, 2.0, 201)
    ripple = a * np.sin(OMEGA * t) + b * np.cos(OMEGA * t)
    model = bench.hanging(PeriodicDisturbance(**effect))
    free = simulate(model, t, [3e5], [0.0])
    np.testing.assert_allclose(free.pressure, 3e5 + ripple, rtol=1e-12)
    held = simulate_held(model, t, np.full(201, 3e5), np.full(201, 0.02))
    np.testing.assert_allclose(held.force, [bench.pull(3e5 + r, 0.02) for r in ripple])


def test_load_on_a_rippling_muscle_against_an_adaptive_solver():
    effect = {'pressure_sin': 5e3, 'frequency': 3.7}
    t = np.linspace(0.0, 2.0, 201)
    y0 = bench.rest(3e5)
    run = simulate(bench.hanging(PeriodicDisturbance(**effect)), t, [3e5], [0.0], position=y0)

    def rhs(s, state, u):
        y, v = state
        p = u + 5e3 * np.sin(OMEGA * s)
        return v, (bench.pull(p, y) - bench.drag(p, y) * v) / bench.MASS - bench.G

    y, _ = bench.solved(rhs, t, (y0, 0.0), ((0.0, 3e5),))
    np.testing.assert_allclose(run.position, y, atol=1e-9)
    assert np.ptp(y) > 1e-3


@pytest.mark.parametrize('frequency', [0.31, 1.7, 12.345, 48.0])
@pytest.mark.parametrize('seed', range(3))
def test_guess_finds_a_line_in_noise_well_within_its_width(frequency, seed):
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 40.0, 0.01) + rng.uniform(-1e-3, 1e-3, 4000)
    line = np.sin(2.0 * np.pi * frequency * t + rng.uniform(0.0, 6.0))
    residual = line + rng.normal(0.0, 1.0, t.size) + 0.1 * t
    starts = PeriodicDisturbance.equations.guess(t, 0 * t, 0 * t, residual)
    assert {'force_sin', 'pressure_sin'} == {s for g in starts for s in g if s.endswith('sin')}
    assert abs(starts[0]['frequency'] - frequency) < 0.1 / 40.0
    for start in starts:
        PeriodicDisturbance(**start)


def test_nothing_to_guess_from_is_no_start():
    t = np.linspace(0.0, 1.0, 100)
    assert PeriodicDisturbance.equations.guess(t, t, t, np.zeros(100)) == ()
