# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Noise of known size and colour is measured as such, on motion that is not noise."""

import numpy as np
import pytest

from pam_ros.identification.data.noise import noise_of, step_of
from support.equations import coloured

SIGMA = 2e-5  # m, with a motion of some 20 mm


def motion(t):
    """Return a load that swings at up to 1 Hz, in m."""
    return 0.02 * np.sin(2 * np.pi * 0.4 * t) + 4e-3 * np.sin(2 * np.pi * 1.0 * t)


@pytest.mark.parametrize(
    ('rate', 'rho', 'low', 'high', 'off'),
    [
        (100.0, 0.0, 0.93, 1.02, 0.03),
        (250.0, 0.0, 0.97, 1.03, 0.03),
        (1000.0, 0.0, 0.98, 1.02, 0.03),
        (250.0, 0.5, 0.95, 1.04, 0.04),
        (1000.0, 0.5, 0.97, 1.03, 0.03),
        (1000.0, 0.9, 0.90, 1.05, 0.03),
        # Windows of few samples hold few independent ones: the quietest of them look quieter
        # and whiter than all are. The floor is then too low, never too high.
        (100.0, 0.5, 0.80, 1.02, 0.15),
        (250.0, 0.9, 0.65, 1.05, 0.12),
        (100.0, 0.9, 0.40, 1.05, 0.35),
    ],
)
def test_size_and_colour_on_smooth_motion(rate, rho, low, high, off):
    t = np.arange(round(60.0 * rate)) / rate
    noise = coloured(np.random.default_rng(1), t.size, rho, SIGMA)
    found = noise_of([(t, motion(t) + noise)])
    assert low < found.sigma / SIGMA < high
    assert found.rho == pytest.approx(rho, abs=off)


def test_steps_and_their_ringing_are_not_noise():
    rate = 200.0
    t = np.arange(round(60.0 * rate)) / rate
    since = t % 3.0
    ringing = 0.01 * np.exp(-4.0 * since) * np.cos(2 * np.pi * 4.0 * since)
    y = 0.02 * (t // 3.0 % 2) + ringing
    found = noise_of([(t, y + coloured(np.random.default_rng(2), t.size, 0.0, SIGMA))])
    assert found.sigma == pytest.approx(SIGMA, rel=0.1)
    assert found.rho < 0.1


@pytest.mark.parametrize('rate', [100.0, 250.0, 1000.0])
def test_stamps_that_jitter_are_no_noise(rate):
    rng = np.random.default_rng(7)
    t = np.arange(round(60.0 * rate)) / rate
    t = t + rng.uniform(-0.15, 0.15, t.size) / rate
    found = noise_of([(t, motion(t) + SIGMA * rng.standard_normal(t.size))])
    # At 100 Hz the load moves by a hundred micrometres in the jitter of a stamp.
    assert 0.93 < found.sigma / SIGMA < 1.03
    assert found.rho < 0.05


@pytest.mark.parametrize(
    ('rate', 'rho', 'low'),
    [(100.0, 0.85, 0.55), (250.0, 0.9, 0.68), (1000.0, 0.9, 0.9)],
)
def test_correlated_noise_of_an_encoder(rate, rho, low):
    t = np.arange(round(60.0 * rate)) / rate
    step = SIGMA
    noise = coloured(np.random.default_rng(8), t.size, rho, SIGMA)
    y = step * np.round((motion(t) + noise) / step)
    whole = np.std(y - motion(t))
    found = noise_of([(t, y)])
    assert low < found.sigma / whole < 1.05
    # Without its resolution, the white rounding error looks like less correlation, and the part
    # of the noise that the polynomials take away is underestimated.
    blind = noise_of([(t, y)], [0.0])
    assert abs(np.log(found.sigma / whole)) < abs(np.log(blind.sigma / whole))
    assert found.rho > blind.rho


def test_an_encoder_at_rest_has_the_noise_of_its_step():
    t = np.arange(2000) / 100.0
    y = 1e-5 * np.round(motion(np.maximum(t - 10.0, 0.0)) / 1e-5)
    assert noise_of([(t, y)]).sigma == pytest.approx(1e-5 / np.sqrt(12.0), rel=1e-6)


def test_a_slow_error_is_not_noise():
    t = np.arange(6000) / 100.0
    slow = coloured(np.random.default_rng(9), t.size, 0.99, 10.0 * SIGMA)
    white = SIGMA * np.random.default_rng(10).standard_normal(t.size)
    # A correlation time of 1 s: what is faster than the windows is some 2 SIGMA.
    assert noise_of([(t, motion(t) + slow + white)]).sigma < 3.0 * SIGMA


@pytest.mark.parametrize('step', [1e-5, 2 * np.pi / 8192, 0.1])
@pytest.mark.parametrize('offset', [0.0, 0.123456])
def test_resolution_of_an_encoder(step, offset):
    t = np.arange(3000) / 100.0
    values = step * np.round(200.0 * np.sin(t) + np.random.default_rng(1).standard_normal(t.size))
    assert step_of(values + offset) == pytest.approx(step, rel=1e-6)
    # Files contain a few digits.
    assert step_of(np.round(values + offset, 6)) == pytest.approx(step, rel=1e-2)
    assert step_of(values[:1]) == 0.0


def test_a_smooth_signal_has_no_resolution():
    rng = np.random.default_rng(2)
    t = np.arange(3000) / 100.0
    assert step_of(motion(t) + SIGMA * rng.standard_normal(t.size)) == 0.0
    # Noiseless, with rests: many samples are equal, but no step divides the others.
    assert step_of(motion(np.minimum(t, 20.0))) == 0.0
    assert step_of(np.full(50, 0.03)) == 0.0


def test_a_few_levels_are_no_resolution():
    """They are those of an experiment: its noise would be a large share of its motion."""
    t = np.arange(3000) / 100.0
    for levels in (2, 5, 40):
        values = 1e-3 * (t // 0.5 % levels)
        assert step_of(values) == 0.0
        assert noise_of([(t, values)]).sigma < 1e-9


def test_scales_with_the_unit_and_pools_signals():
    rng = np.random.default_rng(3)
    t = np.arange(4000) / 200.0
    signals = [(t + start, motion(t) + coloured(rng, t.size, 0.6, SIGMA)) for start in (0.0, 50.0)]
    metres = noise_of(signals)
    millimetres = noise_of([(t, 1e3 * y) for t, y in signals])
    assert millimetres.sigma == pytest.approx(1e3 * metres.sigma, rel=1e-9)
    assert millimetres.rho == pytest.approx(metres.rho, abs=2e-3)
    single = [noise_of([one]) for one in signals]
    between = sorted(n.sigma for n in single)
    assert 0.98 * between[0] < metres.sigma < 1.02 * between[1]


@pytest.mark.parametrize('samples', [1, 5, 12])
def test_a_stretch_shorter_than_a_window_changes_nothing(samples):
    t = np.arange(4000) / 100.0
    y = motion(t) + SIGMA * np.random.default_rng(1).standard_normal(t.size)
    assert noise_of([(t, y), (t[:samples], y[:samples])]) == noise_of([(t, y)])


def test_a_constant_signal_has_no_noise():
    t = np.arange(1000) / 100.0
    assert noise_of([(t, np.full(t.size, 0.03))]).sigma < 1e-12
    # A polynomial that the windows follow exactly is motion, whatever its size.
    assert noise_of([(t, 1e-3 * t**3)]).sigma < 1e-9


def test_too_short_for_a_window_takes_differences():
    rng = np.random.default_rng(4)
    signals = [(np.arange(8) / 10.0, SIGMA * rng.standard_normal(8)) for _ in range(200)]
    found = noise_of(signals)
    # Differences across the joints of 200 signals of white noise are those of white noise.
    assert found.sigma == pytest.approx(SIGMA, rel=0.1)
    assert found.rho == 0.0
