# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The segments of an excitation, each for what it is there for."""

import numpy as np
import pytest

from pam_ros.excitation import waves

RATE = 200.0


def rng(seed=0):
    return np.random.default_rng(seed)


def turns(wave):
    """Return the values at which a wave turns round."""
    moves = np.flatnonzero(np.diff(wave))
    signs = np.sign(np.diff(wave))[moves]
    return wave[moves[np.flatnonzero(np.diff(signs)) + 1]]


@pytest.mark.parametrize('seed', range(5))
def test_steps_visit_both_ends_and_hold_there_longest(seed):
    wave = waves.steps(RATE, 24.0, rng(seed))
    assert wave.shape == (4800,)
    edges = np.flatnonzero(np.diff(wave)) + 1
    holds = np.diff(np.concatenate(([0], edges, [wave.size]))) / RATE
    levels = wave[np.concatenate(([0], edges))]
    assert levels.min() == 0.0
    assert levels.max() == 1.0
    assert holds[levels.argmin()] > 2.5 * np.median(holds)
    assert holds[levels.argmax()] > 2.5 * np.median(holds)
    sizes = np.abs(np.diff(levels))
    assert sizes.max() < 0.45
    assert sizes.min() > 0.05
    assert turns(wave).size >= 8


def test_the_slow_triangle_turns_back_within_itself():
    wave = waves.triangle(RATE, 18.0, rng(), minor_loops=True)
    assert wave[0] == 0.0
    assert wave[-1] == 0.0
    assert wave.max() == pytest.approx(1.0, abs=0.01)
    assert turns(wave).size == 13  # three minor loops a side, and the top
    speed = np.abs(np.diff(wave)) * RATE
    assert np.percentile(speed, 90) == pytest.approx(np.percentile(speed, 10), rel=0.01)


def test_the_plain_triangle_goes_up_and_down():
    wave = waves.triangle(RATE, 2.0, rng(), minor_loops=False)
    assert turns(wave).size == 1
    assert wave.max() > 0.99


@pytest.mark.parametrize('fastest', [2.0, 8.0])
def test_the_multisine_has_lines_up_to_the_fastest_and_none_above(fastest):
    wave = waves.multisine(RATE, 12.0, rng(), fastest)[:, 0]
    assert np.abs(wave - 0.5).max() == pytest.approx(0.35)
    power = np.abs(np.fft.rfft(wave - 0.5)) ** 2
    frequency = np.fft.rfftfreq(wave.size, 1.0 / RATE)
    lines = frequency[power > 1e-6 * power.max()]
    assert lines.size >= 10
    assert lines.max() == pytest.approx(fastest, abs=0.1)
    assert lines.min() < 0.2


def test_the_multisines_of_two_muscles_have_the_same_lines_and_are_not_correlated():
    alone, pair = (waves.multisine(RATE, 12.0, rng(), 8.0, muscles) for muscles in (1, 2))
    np.testing.assert_array_equal(alone[:, 0], pair[:, 0])
    np.testing.assert_allclose(np.abs(pair - 0.5).max(axis=0), 0.35)
    assert abs(np.corrcoef(pair.T)[0, 1]) < 1e-9
    one, other = np.abs(np.fft.rfft(pair - 0.5, axis=0)).T
    lines = one > 1e-3 * one.max()
    assert np.ptp(one[lines] / other[lines]) < 1e-6


def test_the_chirps_reach_the_fastest_at_three_means():
    means, sines = waves.chirp(RATE, 12.0, 8.0)
    wave = means + sines
    for part, mean in zip(np.split(wave, 3), (0.25, 0.5, 0.75), strict=True):
        late = part[-140:-20] - mean
        assert np.abs(late).max() == pytest.approx(0.04, rel=0.05)
        crossings = np.count_nonzero(np.diff(np.sign(late)))
        assert 0.5 * (crossings - 1) * RATE / late.size < 8.0
        assert 0.5 * (crossings + 1) * RATE / late.size > 5.5
    assert np.abs(np.diff(wave)).max() < 0.02  # no jolts


def test_the_same_seed_gives_the_same_wave():
    for make in (
        lambda r: waves.steps(RATE, 20.0, r),
        lambda r: waves.triangle(RATE, 20.0, r, minor_loops=True),
        lambda r: waves.multisine(RATE, 20.0, r, 8.0),
    ):
        np.testing.assert_array_equal(make(rng(4)), make(rng(4)))
        assert np.any(make(rng(4)) != make(rng(5)))
