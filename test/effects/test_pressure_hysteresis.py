# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Hysteresis over pressure against the play operators of Prandtl, and a published loop."""

import numpy as np
import pytest

from pam_ros.effects import Hysteresis, PressureHysteresis
from pam_ros.effects.maxwell_slip import ELEMENTS
from pam_ros.rig.run import simulate_held
from support import bench

Y = 0.03  # m


def path(turns, points=50):
    """Return pressures along straight ways between *turns*, *points* a way."""
    return np.interp(np.arange((len(turns) - 1) * points + 1) / points, range(len(turns)), turns)


def held(p, *effects, y=Y):
    """Return the force of a muscle of constant length along pressures *p*."""
    t = np.arange(float(p.size))
    still = np.zeros(p.size)
    return simulate_held(bench.hanging(*effects), t, p, still + y, still, step=1.0).force


def loop(p, y=Y, **values):
    """Return what the effect adds to that force."""
    return held(p, PressureHysteresis(**values), y=y) - held(p, y=y)


@pytest.mark.slow
@pytest.mark.parametrize(('onset', 'ratio'), [(0.0, 1.0), (0.4, 1.0), (0.1, 10.0)])
def test_slip_over_pressure_is_the_complement_of_prandtls_plays(onset, ratio):
    p, width, half = path(1e5 * np.array([0.0, 3.0, 2.0, 5.0, 4.5, 4.8, 1.0])), 6e4, 8e3
    s = (np.arange(ELEMENTS) + 0.5) / ELEMENTS
    share = s if ratio == 1.0 else (ratio**s - 1.0) / (ratio - 1.0)
    radii = width * (onset + (1.0 - onset) * share)
    slope = (bench.pull(2e5, Y) - bench.pull(1e5, Y)) / 1e5
    play, expected = np.full(ELEMENTS, p[0]), []
    for a in p:
        play = np.maximum(a - radii, np.minimum(a + radii, play))
        expected.append(-half * slope * np.mean((a - play) / radii))
    force = loop(p, slip=half, slip_width=width, slip_onset=onset, slip_ratio=ratio)
    np.testing.assert_allclose(force, expected, atol=1e-7)


def test_held_muscle_shows_the_published_loop_of_pressure():
    # Hunt et al. 2017: filling and venting differ by 15.6 kPa to either side.
    y, half = 0.04, 15.6e3
    p = np.concatenate([np.linspace(0.0, 6e5, 601), np.linspace(6e5, 0.0, 601)])
    force = held(p, PressureHysteresis(slip=half, slip_width=3e4, slip_onset=0.2), y=y)
    level = np.linspace(100.0, 600.0, 6)
    fill = np.interp(level, force[:601], p[:601])
    vent = np.interp(level, force[601:][::-1], p[601:][::-1])
    np.testing.assert_allclose(0.5 * (fill - vent), half, rtol=1e-6)


def test_only_the_pressure_counts_neither_speed_nor_sampling():
    turns = 1e5 * np.array([2.0, 4.0, 3.0, 3.5, 1.0])
    fine, coarse = (loop(path(turns, n), slip=5e3, slip_ratio=3.0) for n in (100, 1))
    np.testing.assert_allclose(fine[::100], coarse, atol=1e-10)


def test_minor_loops_close_and_are_forgotten():
    straight = loop(path(1e5 * np.array([1.0, 4.0, 5.0])), slip=5e3)
    with_loop = loop(path(1e5 * np.array([1.0, 4.0, 3.0, 3.5, 3.0, 4.0, 5.0])), slip=5e3)
    np.testing.assert_allclose(with_loop[-50:], straight[-50:], atol=1e-10)
    assert np.ptp(loop(path(1e5 * np.array([1.0, 4.0, 3.0])), slip=5e3)) > 1.0


@pytest.mark.parametrize('side', [1.0, -1.0])
def test_the_loop_can_start_as_a_long_change_of_pressure_has_left_it(side):
    far, back = np.linspace(3e5, 3e5 + side * 2e5, 401), np.linspace(3e5 + side * 2e5, 3e5, 51)
    come = loop(np.concatenate([far, back]), slip=5e3)[401:]
    np.testing.assert_allclose(loop(back, slip=5e3, initial=side), come, atol=1e-6)


def test_a_muscle_that_shortens_at_constant_pressure_does_not_show_it():
    y = np.linspace(0.0, 0.05, 51)
    t, p, v = np.arange(51.0), np.full(51, 3e5), np.zeros(51)

    def force(*effects):
        return simulate_held(bench.hanging(*effects), t, p, y, v, step=1.0).force

    np.testing.assert_array_equal(force(PressureHysteresis(slip=5e3)), force())
    assert np.abs(force(Hysteresis(slip=5.0)) - force()).max() > 4.0


def test_with_hysteresis_over_contraction_the_forces_add():
    p = path(1e5 * np.array([1.0, 4.0, 3.0]))
    over_p, over_kappa = PressureHysteresis(slip=5e3), Hysteresis(slip=5.0, initial=0.5)
    both, alone = held(p, over_kappa, over_p), held(p)
    expected = held(p, over_p) + held(p, over_kappa) - alone
    np.testing.assert_allclose(both, expected, atol=1e-9)
    assert np.abs(both - alone).max() > 1.0


def test_every_start_is_allowed():
    for start in PressureHysteresis.fit_starts():
        assert PressureHysteresis(**start).is_present
