# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The dead band of the pressure: nothing below, all but the band above, free and held."""

import numpy as np
import pytest
from scipy.interpolate import BPoly

from pam_ros.effects.dead_band import DeadBand, beyond
from pam_ros.rig.run import simulate, simulate_held
from support import bench

EFFECT = [DeadBand(band=4e4, width=5e3)]


def test_of_a_pressure_beyond_the_band_the_band_is_missing():
    t = np.linspace(0.0, 8.0, 81)
    run = simulate(bench.hanging(*EFFECT), t, [3e5, 2e5], [0.0, 1.0])
    np.testing.assert_allclose(run.pressure[1:11], 2.6e5, rtol=1e-14)
    np.testing.assert_allclose(run.pressure[11:], 1.6e5, rtol=1e-14)
    assert abs(run.position[-1] - bench.rest(1.6e5)) < 1e-6


def test_held_force_below_the_band_is_that_of_no_pressure():
    t = np.linspace(0.0, 1.0, 11)
    p, y = np.linspace(0.0, 1e5, 11), np.full(11, 0.03)
    run = simulate_held(bench.hanging(*EFFECT), t, p, y)
    acting = [0.0, 0.0, 0.0, 0.0, 1250.0, 1e4, 2e4, 3e4, 4e4, 5e4, 6e4]
    np.testing.assert_allclose(run.force, [bench.pull(a, 0.03) for a in acting])


def test_a_band_narrower_than_its_corner_leaves_no_pressure_as_it_is():
    rig = bench.hanging(DeadBand(band=1e3, width=5e3))
    run = simulate_held(rig, np.arange(3.0), [0.0, 1e3, 2e3], np.full(3, 0.03))
    np.testing.assert_allclose(run.force, [bench.pull(a, 0.03) for a in (0.0, 250.0, 1e3)])


@pytest.mark.parametrize('band', [0.5e4, 6e4])
def test_the_corner_is_a_parabola_that_meets_both_sides(band):
    """As the Bernstein polynomial of degree 2 over the three points of the corner."""
    width = 4e3
    corner = BPoly([[0.0], [0.0], [width]], [band - width, band + width])
    for p in np.linspace(band - width, band + width, 21):
        assert beyond(p, band, width) == pytest.approx(float(corner(p)), abs=1e-9)
    assert beyond(band - width - 1.0, band, width) == 0.0
    assert beyond(band + width + 1.0, band, width) == width + 1.0
