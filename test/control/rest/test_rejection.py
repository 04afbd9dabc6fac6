# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The level at which disturbances are rejected, from the error alone."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.rest.rejection import Rejection, RejectionTuning

DT = 2e-3
GAINS, TUNING = Gains(), RejectionTuning()
LEAST = TUNING.tolerances * GAINS.rest_tolerance  # m
LARGE = 3.0 * LEAST
FIRST = Rejection(GAINS, TUNING).highest


def rejection(**tuning):
    """Return one that knows the noise of a noiseless position."""
    one = Rejection(GAINS, replace(TUNING, **tuning))
    follow(one, constant(0.0), TUNING.known * DT)
    return one


def follow(one, error, seconds, moves=False, measured=lambda t: 0.0, quiet=math.inf):
    """Let it see an *error* (s -> m); return the levels."""
    levels = []
    for n in range(round(seconds / DT)):
        one.see(DT, error(n * DT), measured(n * DT), moves=moves, quiet=quiet)
        levels.append(one.level)
    return np.array(levels)


def constant(error):
    return lambda t: error


def test_the_first_highest_level_is_a_bandwidth_of_the_observer():
    assert pytest.approx(TUNING.first) == 4.0 * 25.0**FIRST
    assert pytest.approx(0.35, abs=0.01) == FIRST
    revolute = Rejection(Gains(observer_bandwidth=8.0), TUNING)
    assert 8.0 * 12.5**revolute.highest == pytest.approx(TUNING.first)
    for own, highest in ((14.0, TUNING.least), (12.0, TUNING.least)):
        one = Rejection(Gains(observer_bandwidth=own), TUNING)
        assert one.highest == highest
    slow = Rejection(Gains(rejection_bandwidth=3.0), TUNING)
    assert slow.highest == 1.0


def test_it_rises_with_an_error_at_once_and_falls_slowly():
    one = rejection()
    levels = follow(one, constant(LARGE), 0.1)
    assert np.argmax(levels >= FIRST) * DT < 0.03
    levels = follow(one, constant(0.0), TUNING.release)
    high = FIRST * math.exp(-1.0)
    assert levels[-1] == pytest.approx(high, rel=0.15)
    follow(one, constant(0.0), 10 * TUNING.release)
    assert one.level == 0.0


def test_it_is_proportional_to_the_error_between_two_bounds():
    one = rejection(climb=0.0, release=1e-3)
    for size, share in ((0.99, 0.0), (0.5 * (1.0 + TUNING.full), 0.5), (TUNING.full, 1.0)):
        follow(one, constant(size * LEAST), 1.0)
        assert one.level == pytest.approx(share * FIRST, abs=1e-3)


def test_between_is_logarithmic():
    one = rejection()
    assert one.between(4.0, 100.0) == 4.0
    one.level = 0.5
    assert one.between(4.0, 100.0) == pytest.approx(20.0)
    one.level = 1.0
    assert one.between(4.0, 100.0) == pytest.approx(100.0)


def test_the_highest_level_rises_while_it_is_used_and_not_else():
    one = rejection()
    follow(one, constant(LARGE), 1.0)
    assert one.highest == pytest.approx(FIRST + TUNING.climb, abs=0.01)
    follow(one, constant(LARGE), 4.0)
    assert one.highest == one.level == 1.0
    one = rejection()
    follow(one, constant(0.0), 5.0)
    assert one.highest == FIRST


def test_while_the_loop_may_oscillate_it_does_not_rise():
    one = rejection()
    follow(one, constant(LARGE), 5.0, quiet=TUNING.quiet)
    assert one.highest == one.level == FIRST


def test_after_an_oscillation_it_is_lower_and_rises_slowly():
    one = rejection()
    follow(one, constant(LARGE), 10.0)
    assert one.level == 1.0
    one.lower()
    assert one.highest == one.level == TUNING.lower
    # It rises again to below the level of the oscillation, and only slowly beyond.
    follow(one, constant(LARGE), 3.0)
    bound = TUNING.below + 3.0 * TUNING.forget
    assert one.highest == pytest.approx(bound, abs=0.01)
    follow(one, constant(LARGE), 10.0)
    assert one.highest == pytest.approx(min(bound + 10.0 * TUNING.forget, 1.0), abs=0.01)


def test_it_is_never_lowered_to_nothing():
    one = rejection()
    for _ in range(10):
        one.lower()
    assert one.highest == TUNING.least
    assert one.is_least


def test_while_the_reference_moves_and_without_the_gain_it_is_0():
    one = rejection()
    assert not np.any(follow(one, constant(LARGE), 1.0, moves=True))
    one = rejection()
    one.gains = Gains(rejection=False)
    assert not np.any(follow(one, constant(LARGE), 1.0))


def test_after_a_motion_it_waits_until_the_error_has_gone():
    one = rejection()
    follow(one, constant(LARGE), 1.0, moves=True)
    assert not np.any(follow(one, constant(LARGE), 5.0))
    follow(one, constant(0.0), 0.2 + TUNING.calm)
    follow(one, constant(LARGE), 0.1)
    assert one.level > 0.0


def stick_slip(t):
    """Return an error that jumps from one side to the other once a second, within 0.05 s."""
    side = 1.0 if t % 2.0 < 1.0 else -1.0
    return side * 3e-4 * math.cos(math.pi * min(max((t % 1.0 - 0.95) / 0.05, 0.0), 1.0))


def test_after_a_motion_a_shaken_load_is_rejected_and_one_that_sticks_and_slips_is_not():
    for frequency in (0.5, 1.0, 3.0):
        one = rejection()
        follow(one, constant(LARGE), 1.0, moves=True)
        shaken = follow(one, lambda t, f=frequency: 1e-3 * math.sin(2 * math.pi * f * t), 5.0)
        assert shaken[-1] > 0.0, frequency
    one = rejection()
    follow(one, constant(LARGE), 1.0, moves=True)
    assert not np.any(follow(one, stick_slip, 10.0))
    # Nor is a slow approach, which moves one way.
    one = rejection()
    follow(one, constant(LARGE), 1.0, moves=True)
    assert not np.any(follow(one, lambda t: 5e-3 * math.exp(-t), 4.0))


@pytest.mark.parametrize('noise', [20e-6, 1e-4, 1e-3])
def test_the_noise_is_measured_and_is_no_disturbance(noise):
    drawn = noise * np.random.default_rng(1).standard_normal(20_000)
    one = Rejection(GAINS, TUNING)

    def place(t):
        # A load that swings by 20 mm, in addition to the noise.
        return drawn[round(t / DT)] + 0.02 * math.sin(3.0 * t)

    levels = follow(one, lambda t: drawn[round(t / DT)], 20.0, measured=place)
    assert one.noise == pytest.approx(noise, rel=0.15)
    assert np.mean(levels > 0.0) < 0.05
    assert np.max(levels) < 0.5 * FIRST
    # What is above it still is.
    follow(one, constant(3.0 * noise), 0.3, measured=lambda t: place(20.0 + t))
    assert one.level > 0.5 * FIRST


def test_a_start_resets_it():
    one = rejection()
    follow(one, constant(LARGE), 10.0, measured=lambda t: 1e-3 * (round(t / DT) % 2))
    one.start()
    assert (one.level, one.highest, one.noise) == (0.0, FIRST, 0.0)
    follow(one, constant(LARGE), 0.9 * TUNING.known * DT)
    assert one.level == 0.0  # until the noise is known
    follow(one, constant(LARGE), 0.1)
    assert one.level == pytest.approx(FIRST, abs=0.1 * TUNING.climb + 1e-3)
