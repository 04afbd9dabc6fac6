# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Features of the motion: play elements, Stribeck's surplus, a force over the position."""

import math
from itertools import pairwise

import pytest

from pam_ros.control.learning.features import (
    CONSTANT,
    COUNT,
    SLOPES,
    STRIBECK,
    Features,
    FeatureTuning,
)
from pam_ros.control.learning.force_curve import KNOTS

TUNING = FeatureTuning()
REACHES, STROKE = TUNING.reaches, TUNING.stroke
REACH = (0.0, 0.08)  # m


def along(features, path, dt=2e-3):
    for before, now in pairwise(path):
        values = features.follow(dt, now, (now - before) / dt)
    return values


def test_elements_slip_at_their_reach_and_turn_over_by_twice_that():
    features = Features(TUNING, REACH)
    features.start(0.05)
    values = along(features, [0.05, 0.05 + 1e-3])
    bent = [min(1e-3 / reach, 1.0) for reach in REACHES]
    assert values[: len(REACHES)] == pytest.approx(bent)
    values = along(features, [0.05 + 1e-3, 0.05 + 20e-3])
    assert values[: len(REACHES)] == pytest.approx([1.0] * len(REACHES))
    values = along(features, [0.05 + 20e-3, 0.05 + 20e-3 - 2.0 * REACHES[2]])
    assert values[2] == pytest.approx(-1.0)
    assert values[3] == pytest.approx(1.0 - 2.0 * REACHES[2] / REACHES[3])


def test_minor_loops_close():
    features = Features(TUNING, REACH)
    features.start(0.0)
    along(features, [0.0, 10e-3])
    before = list(features.values)
    along(features, [10e-3, 9e-3, 10e-3])
    assert features.values[: len(REACHES)] == pytest.approx(before[: len(REACHES)])


def test_the_rest_is_stribeck_a_force_over_the_position_and_a_constant():
    features = Features(TUNING, REACH)
    features.start(0.03)
    assert features.values[SLOPES] == [0.0] * KNOTS
    values = features.follow(1.0, 0.04, 0.01)
    assert values[STRIBECK] == pytest.approx(math.exp(-1.0))
    # With the same slope at all knots it is a straight line from where the load has started.
    assert sum(values[SLOPES]) == pytest.approx(0.01 / STROKE)
    assert sum(features.rates[SLOPES]) == pytest.approx(0.01 / STROKE)
    assert values[CONSTANT] == 1.0
    assert len(values) == COUNT
    assert len(REACHES) == STRIBECK


def test_there_is_a_size_for_each_feature():
    for sizes in (TUNING.spreads, TUNING.lows, TUNING.highs):
        assert len(sizes) == COUNT
