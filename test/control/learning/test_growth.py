# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The bandwidth grows as far as the lag allows, and only where that is known and asked for."""

import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.learning.growth import Growth
from pam_ros.control.learning.learning_tuning import LearningTuning

DT = 0.002
GAINS = Gains()
LOW, HIGH = GAINS.bandwidth, GAINS.fast_bandwidth
NEGLIGIBLE = 24e-6


def settled(lag=0.0, explained=0.0, known=0.0, error=0.0, gains=GAINS):
    growth = Growth(gains, LearningTuning())
    for n in range(3000):
        growth.see(DT, error if n % 2 else -error, NEGLIGIBLE)
        growth.follow(DT, lag, explained, known)
    return growth.bandwidth


def test_what_was_learned_lets_it_grow_without_an_error():
    assert settled(explained=1.0) == pytest.approx(HIGH)
    assert LOW < settled(explained=0.5) < HIGH


def test_a_known_lag_lets_it_grow_as_far_as_the_error_asks():
    assert settled(known=1.0) == pytest.approx(LOW)
    assert settled(known=1.0, error=NEGLIGIBLE) == pytest.approx(LOW, rel=1e-3)
    assert LOW < settled(known=1.0, error=1.5 * NEGLIGIBLE) < 0.7 * HIGH
    assert settled(known=1.0, error=3.0 * NEGLIGIBLE) == pytest.approx(HIGH)


def test_without_knowledge_of_the_lag_it_stays():
    assert settled(error=1.0) == pytest.approx(LOW)


def test_a_lag_leaves_a_decay_time_of_three_times_itself():
    lag = 1.0 / (3.0 * 25.0)
    assert settled(lag, explained=1.0) == pytest.approx(25.0)
    assert settled(0.2, explained=1.0) == pytest.approx(LOW)  # never below


def test_it_follows_other_gains():
    growth = Growth(GAINS, LearningTuning())
    growth.set_gains(Gains(bandwidth=10.0))
    for _ in range(3000):
        growth.follow(DT, 0.0, 0.0, 0.0)
    assert growth.bandwidth == pytest.approx(10.0)


def test_a_slow_loop_does_not_overshoot():
    growth = Growth(GAINS, LearningTuning())
    growth.see(5.0, 1.0, NEGLIGIBLE)
    growth.follow(5.0, 0.0, 0.0, 1.0)
    assert growth.bandwidth == pytest.approx(HIGH)
