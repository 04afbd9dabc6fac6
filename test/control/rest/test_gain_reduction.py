# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The share of the feedback gains: lower for a loop that oscillates, and for nothing else."""

import math
from itertools import pairwise

import pytest

from pam_ros.control.rest.gain_reduction import OF_THE_LOOP, GainReduction, ReductionTuning

DT, LEAST, BANDWIDTH = 2e-3, 40e-6, 20.0
TUNING = ReductionTuning()
QUICK, SLOW = 1.3 * BANDWIDTH, 0.7 * BANDWIDTH  # rad/s of an error


def calm(t):
    return 0.0


def sine(frequency, amplitude=1e-3):
    return lambda t: amplitude * math.sin(frequency * t)


def reduction():
    return GainReduction(TUNING)


def see(it, error, seconds, speed=calm):
    """Let *it* see an *error* (s -> m) and the *speed* of the reference; return all shares."""
    shares = []
    for n in range(round(seconds / DT)):
        it.see(DT, error(n * DT), speed(n * DT), LEAST, BANDWIDTH)
        shares.append(it.share)
    return shares


def test_an_oscillation_lowers_the_share_step_by_step_to_the_least():
    shares = see(reduction(), sine(QUICK), 10.0)
    levels = sorted(set(shares), reverse=True)
    for before, after in pairwise(levels):
        assert after == pytest.approx(max(TUNING.lower * before, TUNING.least))
    assert shares[0] == 1.0
    assert shares[-1] == TUNING.least


def test_it_says_when_it_reduces_the_share():
    it, error = reduction(), sine(QUICK)
    for n in range(round(5.0 / DT)):
        before = it.share
        assert it.see(DT, error(n * DT), 0.0, LEAST, BANDWIDTH) is (it.share < before)
    assert it.share == TUNING.least


def test_a_load_that_bounces_on_a_stop_is_quicker_than_the_loop():
    ratio = OF_THE_LOOP.quickest
    assert see(reduction(), sine(0.9 * ratio * BANDWIDTH), 5.0)[-1] < 1.0
    assert set(see(reduction(), sine(1.2 * ratio * BANDWIDTH), 5.0)) == {1.0}


def test_a_slow_error_and_noise_change_nothing():
    assert set(see(reduction(), sine(SLOW), 20.0)) == {1.0}
    assert set(see(reduction(), sine(QUICK, 0.9 * LEAST), 20.0)) == {1.0}


@pytest.mark.parametrize(('size', 'is_found'), [(0.9, False), (1.1, True)])
def test_swings_smaller_than_the_motion_of_the_reference_are_none(size, is_found):
    """The error swings by *size* times the distance of the reference in half a period."""
    speed = 0.02  # m/s
    swing = size * speed * math.pi / BANDWIDTH
    shares = see(reduction(), sine(QUICK, 0.5 * swing), 5.0, lambda t: speed)
    assert (min(shares) < 1.0) == is_found


def test_the_speed_of_the_reference_is_remembered_for_a_period():
    """A reference that comes to rest leaves an error that has followed it."""
    swing = 0.5 * 0.02 * math.pi / BANDWIDTH
    shares = see(reduction(), sine(QUICK, 0.5 * swing), 2.0, lambda t: 0.02 if t < 0.5 else 0.0)
    first = next(n for n, share in enumerate(shares) if share < 1.0) * DT
    forgotten = 0.5 + TUNING.memory * math.log(2.0)  # until the swing is large enough
    assert forgotten < first < forgotten + 4.0 * math.pi / QUICK


def test_after_an_oscillation_the_share_rises_slowly():
    it = reduction()
    assert see(it, sine(QUICK), 0.5)[-1] == TUNING.lower
    shares = see(it, calm, 20.0)
    assert shares[-1] == pytest.approx(TUNING.lower + 20.0 * TUNING.forget, rel=1e-3)
    assert see(it, calm, 0.5 / TUNING.forget)[-1] == 1.0


def test_an_oscillation_that_feedback_does_not_cause_is_forgotten_at_once():
    """It lasts with hardly any feedback: a vibration."""
    it = reduction()
    assert see(it, sine(QUICK), 20.0)[-1] == TUNING.least
    shares = see(it, calm, TUNING.quiet + 1.0 / TUNING.restore)
    steps = [b - a for a, b in pairwise(shares)]
    assert max(steps) == pytest.approx(TUNING.restore * DT)
    assert shares[-1] == 1.0


def test_a_start_keeps_the_share_and_other_gains_do_not():
    it = reduction()
    see(it, sine(QUICK), 0.5)
    it.start()
    assert it.share == TUNING.lower
    it.reset()
    assert it.share == 1.0
    assert set(see(it, calm, 1.0)) == {1.0}
