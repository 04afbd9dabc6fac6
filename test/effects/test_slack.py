# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Slack: the pull with its corner, and a load that falls freely when the muscle is slack."""

import numpy as np
import pytest

from pam_ros.effects import Slack
from pam_ros.rig.run import simulate, simulate_held
from support import bench


def slackened(f, toe, push):
    return Slack.equations.force(f, 0.0, 0.0, 0.0, 0.0, 0.0, [], 0, [], [1.0, toe, push], 0)


@pytest.mark.parametrize('push', [0.0, 12.0])
@pytest.mark.parametrize('toe', [1.0, 25.0])
def test_corner_is_round_and_nothing_changes_beyond_it(toe, push):
    f = np.linspace(-100.0, 100.0, 20001)
    out = np.array([slackened(a, toe, push) for a in f])
    np.testing.assert_array_equal(out[f >= toe - push], f[f >= toe - push])
    np.testing.assert_array_equal(out[f <= -toe - push], -push)
    slope = np.gradient(out, f)
    assert np.all(np.diff(out) >= 0.0)
    assert np.max(np.abs(np.diff(slope))) < 0.011 / toe  # one curvature, 1/(2 toe), no jumps
    assert slackened(-push, toe, push) == pytest.approx(toe / 4.0 - push)


def test_held_muscle_pulls_or_is_slack():
    p = np.linspace(0.0, 4e5, 101)
    t = np.linspace(0.0, 1.0, 101)
    y = np.full(101, 0.15 * bench.L0)
    run = simulate_held(bench.hanging(Slack(share=1.0, toe=1e-3)), t, p, y)
    expected = np.maximum([bench.pull(a, y[0]) for a in p], 0.0)
    np.testing.assert_allclose(run.force, expected, atol=1e-3)
    assert expected[0] == 0.0 < expected[-1]


def test_half_a_share_misses_half_the_push():
    assert (
        Slack.equations.force(-40.0, 0.0, 0.0, 0.0, 0.0, 0.0, [], 0, [], [0.5, 1.0, 0.0], 0)
        == -20.0
    )


def test_load_falls_freely_while_the_muscle_is_slack():
    t = np.linspace(0.0, 0.05, 51)
    y0 = 0.12
    model = bench.hanging(Slack(share=1.0, toe=1e-3))
    run = simulate(model, t, [0.0], [0.0], position=y0)

    def rhs(_, state, u):
        y, v = state
        pull = bench.pull(u, y)
        return v, -bench.G if pull < 0.0 else (pull - bench.drag(u, y) * v) / bench.MASS - bench.G

    y, _ = bench.solved(rhs, t, (y0, 0.0))
    np.testing.assert_allclose(run.position, y, atol=1e-9)
    assert bench.pull(0.0, y[-1]) < 0.0
