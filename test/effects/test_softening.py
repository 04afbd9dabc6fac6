# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Softening against the closed form of a gain that approaches its limit."""

import numpy as np
import pytest

from pam_ros.effects import Softening, softening
from pam_ros.rig.run import simulate, simulate_held
from support import bench

Y = 0.03
LIMIT = 0.08


def held_gain(effect, t, p, y, step=1e-3):
    """Return the share of the pull that is left, at every stamp."""
    still = np.zeros(t.size)
    soft = simulate_held(bench.hanging(Softening(**effect)), t, p, y, still, step).force
    return soft / simulate_held(bench.hanging(), t, p, y, still, step).force


@pytest.mark.parametrize('step', [1e-3, 1e-2])
def test_time_alone_softens_exponentially(step):
    t = np.linspace(0.0, 60.0, 601)
    gain = held_gain({'limit': LIMIT, 'per_second': 0.05}, t, np.full(601, 4e5), 0 * t + Y, step)
    np.testing.assert_allclose(gain, 1.0 - LIMIT * (1.0 - np.exp(-0.05 * t)), rtol=1e-12)


def test_cycles_of_pressure_soften_by_their_travel_less_the_play_at_each_reversal():
    swing, rate = 3e5, 4e-7
    corners = np.arange(11.0)  # five cycles: up in 1 s, down in 1 s
    t = np.linspace(0.0, 10.0, 1001)
    p = 1e5 + swing * np.interp(t, corners, corners % 2)
    gain = held_gain({'limit': LIMIT, 'per_pressure': rate}, t, p, 0 * t + Y)
    # Play swallows its half width at the start, and all of it after each turn.
    way = swing - softening.BAND + np.arange(10) * (swing - 2.0 * softening.BAND)
    expected = 1.0 - LIMIT * (1.0 - np.exp(-rate * way))
    np.testing.assert_allclose(gain[100::100], expected, rtol=1e-12)


def test_strokes_soften_too():
    rate = 0.8
    t = np.linspace(0.0, 1.0, 101)
    y = 0.08 * t
    gain = held_gain({'limit': LIMIT, 'per_contraction': rate}, t, 0 * t + 4e5, y)
    way = 0.08 / bench.L0 - softening.BAND_KAPPA
    assert gain[-1] == pytest.approx(1.0 - LIMIT * (1.0 - np.exp(-rate * way)), rel=1e-12)


def test_noise_of_the_sensor_is_no_work():
    t = np.linspace(0.0, 50.0, 5001)
    p = 3e5 + np.clip(np.random.default_rng(1).normal(0.0, 900.0, t.size), -4e3, 4e3)
    gain = held_gain({'limit': LIMIT, 'per_pressure': 1e-6}, t, p, 0 * t + Y)
    assert gain[-1] > 1.0 - LIMIT * (1.0 - np.exp(-1e-6 * 8e3))


def test_load_sinks_as_the_muscle_softens():
    t = np.linspace(0.0, 20.0, 101)
    softens = Softening(limit=LIMIT, per_second=0.2)
    run = simulate(bench.hanging(softens), t, [3e5], [0.0])

    def rhs(s, state, u):
        y, v = state
        gain = 1.0 - LIMIT * (1.0 - np.exp(-0.2 * s))
        return v, (gain * bench.pull(u, y) - bench.drag(u, y) * v) / bench.MASS - bench.G

    y, _ = bench.solved(rhs, t, (bench.rest(3e5), 0.0), ((0.0, 3e5),))
    np.testing.assert_allclose(run.position, y, atol=1e-8)
    assert y[-1] < y[0] - 1e-3
