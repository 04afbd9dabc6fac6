# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The payload against the equation of motion with another mass, written out."""

import numpy as np
import pytest

from pam_ros.effects import Payload
from pam_ros.rig.run import simulate
from support import bench


@pytest.mark.parametrize('more', [-3.0, 5.0])
def test_load_moves_with_weight_and_inertia_of_the_sum(more):
    t = np.linspace(0.0, 1.0, 101)
    y0 = bench.rest(3e5)
    run = simulate(bench.hanging(Payload(mass=more)), t, [0.0], [3e5], position=y0)
    m = bench.MASS + more

    def rhs(_, state, u):
        y, v = state
        return v, (bench.pull(u, y) - bench.drag(u, y, m) * v) / m - bench.G

    y, v = bench.solved(rhs, t, (y0, 0.0), ((0.0, 3e5),))
    np.testing.assert_allclose(run.position, y, atol=1e-9)
    np.testing.assert_allclose(run.velocity, v, atol=1e-7)
    assert np.ptp(y) > 1e-3


def test_load_is_never_less_than_a_fifth():
    t = np.array([0.0, 0.5])
    run = simulate(bench.cart(Payload(mass=-50.0), mass=10.0), t, [0.0], [6.0], position=0.0)
    assert run.velocity[1] == pytest.approx(6.0 / 2.0 * 0.5)
