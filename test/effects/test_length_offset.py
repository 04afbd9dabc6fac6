# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The length offset against the force law at the contraction that is felt."""

import numpy as np
import pytest

from pam_ros.effects import LengthOffset
from pam_ros.rig.run import simulate, simulate_held
from support import bench


@pytest.mark.needs_numba
@pytest.mark.parametrize('offset', [-0.03, 0.05])
def test_isometric_force_is_that_of_the_shifted_contraction(offset):
    y = np.linspace(0.0, 0.2 * bench.L0, 50)
    t = 10.0 * np.arange(50)  # so slowly that damping is nothing
    p = np.linspace(1e5, 5e5, 50)
    model = bench.hanging(LengthOffset(offset=offset))
    run = simulate_held(model, t, p, y, velocity=np.zeros(50))
    expected = [bench.pull(a, b + offset * bench.L0) for a, b in zip(p, y, strict=True)]
    np.testing.assert_allclose(run.force, expected, rtol=1e-12, atol=1e-9)


def test_load_swings_about_a_moved_equilibrium():
    offset = 0.02
    model = bench.hanging(LengthOffset(offset=offset))
    t = np.linspace(0.0, 1.0, 101)
    y0 = bench.rest(3e5)
    run = simulate(model, t, [3e5], [0.0], position=y0)

    def rhs(_, state, u):
        y, v = state
        felt = y + offset * bench.L0
        net = bench.pull(u, felt) - bench.drag(u, felt) * v
        return v, net / bench.MASS - bench.G

    y, _ = bench.solved(rhs, t, (y0, 0.0), ((0.0, 3e5),))
    np.testing.assert_allclose(run.position, y, atol=1e-9)
    assert np.ptp(y) > 1e-3
