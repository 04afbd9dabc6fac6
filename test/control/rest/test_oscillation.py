# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Distinguish a loop that oscillates by itself from a disturbance and from a damped response."""

import math

import numpy as np
import pytest

from pam_ros.control.rest.oscillation import Oscillation, OscillationTuning

DT, LEAST, BANDWIDTH = 2e-3, 20e-6, 25.0
TUNING = OscillationTuning()
QUICK = TUNING.quick * BANDWIDTH  # rad/s


def found(error, seconds=4.0, cut=lambda t: False):
    """Return the times in s at which an *error* (s -> m) is seen as an oscillation."""
    oscillation, times = Oscillation(TUNING), []
    for n in range(round(seconds / DT)):
        t = n * DT
        if oscillation.see(DT, error(t), LEAST, BANDWIDTH, is_cut=cut(t)):
            times.append(t)
    return times


def sine(frequency, amplitude=1e-4):
    return lambda t: amplitude * math.sin(frequency * t)


@pytest.mark.parametrize('ratio', [1.05, 1.5, 2.2])
def test_a_quick_sine_is_found_at_the_third_turn(ratio):
    times = found(sine(ratio * QUICK))
    # The third turn ends the third swing; it is seen when the error has come back by LEAST.
    turn = (2.5 * math.pi + math.acos(1.0 - LEAST / 1e-4)) / (ratio * QUICK)
    assert times[0] == pytest.approx(turn, abs=1.5 * DT)
    assert len(times) > 2


def test_a_slow_sine_is_a_disturbance():
    assert not found(sine(0.95 * QUICK), 20.0)
    assert not found(sine(0.2 * QUICK, 5e-3), 20.0)


def test_at_a_limit_of_the_command_a_slow_one_is_found_too():
    assert found(sine(0.3 * QUICK, 2e-2), cut=lambda t: t % 0.4 < 0.1)


@pytest.mark.parametrize(('damping', 'is_found'), [(0.3, False), (0.12, False), (0.05, True)])
def test_a_response_that_decays_is_none(damping, is_found):
    w = 1.5 * QUICK

    def ring(t):
        return 1e-3 * math.exp(-damping * w * t) * math.sin(w * math.sqrt(1 - damping**2) * t)

    assert bool(found(ring)) is is_found


def test_noise_and_small_swings_are_none():
    noise = np.random.default_rng(3).standard_normal(50_000)
    assert not found(lambda t: 0.25 * LEAST * noise[round(t / DT)], 100.0)
    assert not found(sine(1.5 * QUICK, 0.95 * LEAST))


def test_it_is_found_on_a_slow_disturbance_that_is_larger():
    assert found(lambda t: sine(1.5 * QUICK)(t) + sine(0.1 * QUICK, 5e-4)(t))


def test_how_long_there_was_none():
    oscillation = Oscillation(TUNING)
    for n in range(1000):
        oscillation.see(DT, sine(0.2 * QUICK)(n * DT), LEAST, BANDWIDTH, is_cut=False)
    assert oscillation.quiet == pytest.approx(1000 * DT)
    for n in range(1000):
        oscillation.see(DT, sine(1.5 * QUICK)(n * DT), LEAST, BANDWIDTH, is_cut=False)
    assert oscillation.quiet < math.pi / (1.5 * QUICK) + 2 * DT
    oscillation.start()
    assert oscillation.quiet == 0.0


@pytest.mark.parametrize('growth', [1.1, 1.2, 1.5])
def test_slow_swings_that_grow_without_end_are_found(growth):
    """Each swing is *growth* times the one before, as those of an unstable loop."""
    w = 0.4 * QUICK
    times = found(lambda t: 1e-4 * growth ** (w * t / math.pi) * math.sin(w * t), 6.0)
    assert times
    assert times[0] * w / math.pi < (5.5 if growth > 1.2 else 12.0)


def test_a_response_to_a_slow_force_that_begins_is_none():
    w, damping = 0.6 * QUICK, 0.15

    def response(t):
        return 1e-3 * (1.0 - math.exp(-damping * w * t)) * math.sin(w * t)

    assert not found(response, 10.0)


def test_whether_swings_rise():
    for growth, rises in ((1.0, False), (1.03, False), (1.07, True)):
        oscillation, w = Oscillation(TUNING), 0.4 * QUICK
        for n in range(round(4.0 / DT)):
            t = n * DT
            error = 1e-3 * growth ** (w * t / math.pi) * math.sin(w * t)
            oscillation.see(DT, error, LEAST, BANDWIDTH, is_cut=False)
        assert oscillation.is_rising is rises


def test_much_quicker_swings_are_not_those_of_the_loop():
    assert found(sine(0.9 * TUNING.quickest * BANDWIDTH))
    assert not found(sine(1.2 * TUNING.quickest * BANDWIDTH))
