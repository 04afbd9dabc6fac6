# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Dead time: the answer is that to the same commands, stamped later."""

import numpy as np
import pytest

from pam_ros.effects import DeadTime
from pam_ros.rig.run import simulate, simulate_held
from pam_ros.rig.simulation import Simulation
from support import bench

COMMANDS = np.array([0.0, 0.3, 0.55, 0.9])
VALUES = np.array([3e5, 3.5e5, 2.5e5, 3e5])


@pytest.mark.parametrize('delay', [0.02, 0.0123, 0.3])
def test_delay_is_a_later_stamp(delay):
    t = np.linspace(0.0, 1.5, 301)
    late = simulate(bench.hanging(DeadTime(delay=delay)), t, VALUES, COMMANDS)
    stamped = simulate(bench.hanging(), t, VALUES, COMMANDS + delay * (COMMANDS > 0.0))
    np.testing.assert_allclose(late.position, stamped.position, atol=1e-10)
    np.testing.assert_array_equal(late.pressure, stamped.pressure)


def test_a_force_source_moves_only_after_the_delay():
    delay, push = 0.05, 8.0
    t = np.linspace(0.0, 0.5, 51)
    run = simulate(bench.cart(DeadTime(delay=delay)), t, [0.0, push], [-1.0, 0.1], position=0.0)
    after = np.maximum(t - 0.1 - delay, 0.0)
    np.testing.assert_allclose(run.position, 0.5 * push / bench.MASS * after**2, atol=1e-14)


def test_a_stepped_rig_takes_the_command_at_the_first_step_after_the_delay():
    rig = Simulation([bench.cart(DeadTime(delay=0.0105))])
    rig.command([5.0])
    pressures = []
    for _ in range(15):
        rig.advance()
        pressures.append(rig.pressure[0])
    assert pressures == [0.0] * 11 + [5.0] * 4


def test_held_muscle_feels_the_pressure_of_some_time_ago():
    t = np.linspace(0.0, 2.0, 401)
    p = 2e5 + 1e5 * np.sin(6.0 * t)
    run = simulate_held(
        bench.hanging(DeadTime(delay=0.0237)), t, p, np.full(t.size, 0.03), 0.0 * t
    )
    expected = np.interp(t - 0.0237, t, p)
    np.testing.assert_allclose(run.pressure, expected, rtol=1e-12)
    np.testing.assert_allclose(run.force, [bench.pull(a, 0.03) for a in expected], rtol=1e-12)
