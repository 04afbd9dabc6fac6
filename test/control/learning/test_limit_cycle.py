# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Distinguish oscillation between the limits from a step, a blocked load, noise at a limit."""

import numpy as np
import pytest

from pam_ros.control.learning.learning_tuning import LearningTuning
from pam_ros.control.learning.limit_cycle import LimitCycle

DT = 0.002


def found_at(cuts):
    """Return the index at which an oscillation is found, None if it is not."""
    watch = LimitCycle(LearningTuning())
    return next((n for n, cut in enumerate(cuts) if watch.see(DT, cut)), None)


@pytest.mark.parametrize('frequency', [1.0, 3.0, 6.0])
@pytest.mark.parametrize('share', [0.7, 1.0], ids='of the time: {}'.format)
def test_an_oscillation_between_the_limits_is_found_within_two_seconds(frequency, share):
    wave = np.sin(2.0 * np.pi * frequency * DT * np.arange(3000))
    most = np.cos(0.5 * np.pi * share)
    index = found_at(np.where(np.abs(wave) > most, 80.0 * np.sign(wave), 0.0))
    assert index is not None
    assert 0.1 < index * DT < 2.0


def test_a_step_that_is_cut_at_both_ends_is_none():
    cuts = np.concatenate([np.full(75, 50.0), np.full(75, -50.0), np.zeros(2000)])
    assert found_at(np.tile(cuts, 3)) is None


def test_a_load_that_is_blocked_is_none():
    assert found_at(np.full(5000, 300.0)) is None


def test_noise_at_a_limit_of_the_rate_is_none():
    assert found_at(np.random.default_rng(3).normal(0.0, 10.0, 20_000)) is None


def test_the_size_of_the_cut_does_not_count_and_a_new_start_forgets():
    watch = LimitCycle(LearningTuning())
    one = [1e-9] * 60 + [-1e-9] * 60
    assert not any(watch.see(DT, cut) for cut in one)
    watch.start()
    assert not any(watch.see(DT, cut) for cut in one)
    assert any(watch.see(DT, cut) for cut in one * 4)
