# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Whether the loop or a force causes an oscillation, from swings without feedback."""

import math

import pytest

from pam_ros.control.rest.cause import CauseTest, CauseTuning

DT, FREQUENCY = 2e-3, 18.0  # s, rad/s of the joint itself
TUNING = CauseTuning()


def swings_of(error, seconds):
    """Return the times in s at which the *error* (s -> m) turns, and each swing until then."""
    times = [n * DT for n in range(round(seconds / DT))]
    values = [error(t) for t in times]
    turns = [
        n
        for n in range(1, len(values) - 1)
        if (values[n] - values[n - 1]) * (values[n + 1] - values[n]) < 0.0
    ]
    return {
        times[n]: abs(values[n] - values[before])
        for before, n in zip([0, *turns], turns, strict=False)
    }


def verdict(error, before, seconds=12.0):
    """Return what the test says of an *error*, and when in s."""
    test, ended = CauseTest(TUNING, before), swings_of(error, seconds)
    for n in range(round(seconds / DT)):
        cause = test.see(DT, ended.get(n * DT), math.pi / FREQUENCY)
        if cause is not None:
            return cause, n * DT
    raise AssertionError('no verdict')


def free(damping, amplitude=1e-3):
    """Return the error of a joint that is left alone."""
    return lambda t: amplitude * math.exp(-damping * FREQUENCY * t) * math.sin(FREQUENCY * t)


def forced(frequency, amplitude=1e-3):
    return lambda t: amplitude * math.cos(frequency * t)


@pytest.mark.parametrize('damping', [0.03, 0.06, 0.15, 0.5])
def test_an_oscillation_that_decays_is_of_the_loop(damping):
    cause, at = verdict(free(damping), before=2e-3)
    assert cause == 0.0
    assert at < 2.5


def test_a_joint_that_does_not_move_any_more_is_of_the_loop():
    cause, at = verdict(lambda t: 0.0, before=2e-3)
    assert cause == 0.0
    assert at == pytest.approx(TUNING.patience * math.pi / FREQUENCY, abs=2 * DT)


@pytest.mark.parametrize('ratio', [0.6, 0.9, 1.1, 2.0])
def test_a_response_that_stays_is_of_a_force(ratio):
    cause, at = verdict(forced(ratio * FREQUENCY), before=2e-3)
    assert cause == pytest.approx(2e-3, rel=0.02)
    assert at < 8.0 * math.pi / (ratio * FREQUENCY)


@pytest.mark.parametrize('damping', [0.06, 0.15])
def test_a_joint_that_rings_when_feedback_ends_does_not_hide_the_force(damping):
    ring, force = free(damping), forced(1.15 * FREQUENCY)
    cause, _ = verdict(lambda t: ring(t) + force(t), before=1.5e-3)
    assert cause == pytest.approx(2e-3, rel=0.3)


def test_a_response_that_builds_up_is_of_a_force():
    force = forced(FREQUENCY, 4e-3)
    cause, _ = verdict(lambda t: (1.0 - math.exp(-0.1 * FREQUENCY * t)) * force(t), before=1e-3)
    assert cause > 2e-3
