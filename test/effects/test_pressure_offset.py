# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The pressure offset: an affine map from command to chamber, free and held."""

import numpy as np

from pam_ros.effects import PressureOffset
from pam_ros.rig.run import simulate, simulate_held
from support import bench

EFFECT = [PressureOffset(offset=-4e3, gain=0.06)]


def test_chamber_has_the_affine_pressure_and_the_load_rests_there():
    t = np.linspace(0.0, 8.0, 81)
    run = simulate(bench.hanging(*EFFECT), t, [3e5, 2e5], [0.0, 1.0])
    np.testing.assert_allclose(run.pressure[1:11], 1.06 * 3e5 - 4e3, rtol=1e-14)
    np.testing.assert_allclose(run.pressure[11:], 1.06 * 2e5 - 4e3, rtol=1e-14)
    assert abs(run.position[-1] - bench.rest(1.06 * 2e5 - 4e3)) < 1e-6


def test_held_force_is_that_of_the_affine_pressure():
    t = np.linspace(0.0, 1.0, 11)
    p, y = np.linspace(1e5, 5e5, 11), np.full(11, 0.03)
    run = simulate_held(bench.hanging(*EFFECT), t, p, y)
    np.testing.assert_allclose(run.force, [bench.pull(1.06 * a - 4e3, 0.03) for a in p])
