# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Three poles in series against the step response of three equal lags."""

import math

import numpy as np
import pytest

from pam_ros.control.learning.cascade import Cascade


def test_a_step_gives_the_response_of_three_equal_lags():
    cascade, bandwidth, dt = Cascade([0.0, 5.0]), 20.0, 1e-5
    for _ in range(10_000):
        cascade.follow(dt, bandwidth, [2.0, 5.0])
    x = bandwidth * 0.1
    rest = math.exp(-x) * (1.0 + x + 0.5 * x * x)
    assert cascade.output[0] == pytest.approx(2.0 * (1.0 - rest), rel=1e-3)
    assert cascade.output[1] == 5.0


def test_it_is_the_recursion_of_each_signal_to_the_bit():
    rng = np.random.default_rng(3)
    signals = rng.normal(size=(50, 4))
    cascade, stages = Cascade([0.5] * 4), np.full((3, 4), 0.5)
    share = 1.0 - math.exp(-60.0 * 2e-3)
    for row in signals:
        cascade.follow(2e-3, 60.0, row.tolist())
        for n in range(3):
            stages[n] += share * ((row if n == 0 else stages[n - 1]) - stages[n])
    assert cascade.output == stages[2].tolist()
    assert np.array_equal(np.transpose(cascade.stages), stages)


def test_the_number_of_signals_stays():
    with pytest.raises(ValueError, match='zip'):
        Cascade([0.0, 0.0]).follow(1e-3, 60.0, [1.0])
