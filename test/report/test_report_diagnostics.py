# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes, correlations and spectra, against closed forms for signals whose statistics are known."""

import numpy as np
import pytest
from scipy.signal import lfilter

from pam_ros.report import diagnostics


def ar1(rho, n, rng):
    """Return unit AR(1) noise."""
    e = rng.standard_normal(n + 200) * np.sqrt(1.0 - rho**2)
    return lfilter([1.0], [1.0, -rho], e)[200:]


def test_size_of_known_residuals():
    size = diagnostics.size_of([np.array([3.0, -4.0])], [np.array([10.0, 20.0])])
    assert size.rmse == pytest.approx(np.sqrt(12.5))
    assert size.maximum == 4.0
    # |e| = 5, |y - mean| = sqrt(50)
    assert size.fit_percent == pytest.approx(100.0 * (1.0 - 5.0 / np.sqrt(50.0)))


def test_size_pools_runs_and_is_nan_without_any():
    a, b = np.full(50, 1.0), np.full(150, 3.0)
    y = np.linspace(0.0, 1.0, 50), np.linspace(0.0, 1.0, 150)
    assert diagnostics.size_of([a, b], y).rmse == pytest.approx(np.sqrt(0.25 * 1 + 0.75 * 9))
    assert np.isnan(diagnostics.size_of([], []).rmse)


@pytest.mark.parametrize('rho', [0.0, 0.9])
def test_interval_of_rmse_contains_the_true_value_at_its_stated_rate(rho):
    rng = np.random.default_rng(1)
    hits = 0
    for _ in range(400):
        size = diagnostics.size_of([ar1(rho, 8000, rng)], [np.arange(8000.0)])
        hits += size.low <= 1.0 <= size.high
    # 95 % of 400 is 380 with a standard deviation of 4.4.
    assert 363 <= hits <= 396


def test_resampling_takes_means_and_keeps_a_slow_signal():
    t = np.arange(1000) / 1000.0
    slow = np.sin(2 * np.pi * t)
    fast = np.sin(2 * np.pi * 200.0 * t)
    out = diagnostics.resampled(t, slow + fast, 0.01)
    assert out.size == 100
    middles = 0.0045 + 0.01 * np.arange(100)
    # The mean over 10 ms of a 1 Hz sine is sinc(0.01) of it; 200 Hz averages to nothing.
    assert out == pytest.approx(np.sinc(0.01) * np.sin(2 * np.pi * middles), abs=1e-4)


def test_resampling_bridges_jitter():
    rng = np.random.default_rng(0)
    t = np.arange(2000) / 200.0 + rng.uniform(-1e-3, 1e-3, 2000)
    out = diagnostics.resampled(t, 3.0 * t, 0.05)
    assert np.diff(out) == pytest.approx(0.15, rel=0.01)


def test_autocorrelation_of_ar1_noise_is_its_power_law():
    rng = np.random.default_rng(2)
    parts = [ar1(0.8, 40_000, rng) for _ in range(3)]
    found, band = diagnostics.autocorrelation(parts, 10)
    assert found == pytest.approx(0.8 ** np.arange(11), abs=0.02)
    assert band == pytest.approx(1.96 / np.sqrt(120_000))


def test_cross_correlation_finds_the_lag_and_the_sign():
    rng = np.random.default_rng(4)
    u = rng.standard_normal(5000)
    e = np.concatenate([np.zeros(7), -u[:-7]])
    found, band = diagnostics.cross_correlation([u], [e], 10, 20)
    assert np.argmin(found) == 10 + 7
    assert found.min() == pytest.approx(-1.0, abs=0.01)
    assert np.max(np.abs(np.delete(found, 10 + 7))) < 2.0 * band < 0.2


def test_ljungs_band_holds_for_coloured_signals():
    rng = np.random.default_rng(5)
    outside = total = 0
    for _ in range(150):
        u, e = ar1(0.95, 4000, rng), ar1(0.9, 4000, rng)
        found, band = diagnostics.cross_correlation([u], [e], 20, 20)
        outside += np.count_nonzero(np.abs(found) > band)
        total += found.size
    # 1 % when the colours are known; they are estimated from the same samples.
    assert 0.002 < outside / total < 0.03


def test_spectrum_of_white_and_coloured_noise_is_the_formula():
    rng = np.random.default_rng(6)
    for rho in (0.0, 0.7):
        f, density = diagnostics.spectrum([2.0 * ar1(rho, 200_000, rng)], 0.005, 1.0)
        expected = diagnostics.noise_density(2.0, rho, 0.005, f)
        inner = slice(2, -2)
        assert density[inner] == pytest.approx(expected[inner], rel=0.2)
        # Parseval: the density's power is the variance.
        assert np.sum(density**2) * f[0] == pytest.approx(4.0, rel=0.05)


def test_coherence_is_high_where_related_and_below_its_level_elsewhere():
    rng = np.random.default_rng(7)
    u, noise = rng.standard_normal(40_000), rng.standard_normal(40_000)
    f, related, level = diagnostics.coherence([u], [u + noise], 0.01)
    assert np.median(related) == pytest.approx(0.5, abs=0.05)
    _, unrelated, _ = diagnostics.coherence([u], [noise], 0.01)
    assert np.mean(unrelated < level) == pytest.approx(0.95, abs=0.05)
    assert f[-1] == pytest.approx(50.0)


@pytest.mark.parametrize('lengths', [(2000,), (300, 300), (400, *12 * [60])])
def test_coherence_of_short_parts_has_a_level_that_unrelated_signals_keep(lengths):
    rng = np.random.default_rng(8)
    below = []
    for _ in range(100):
        u, e = ([rng.standard_normal(n) for n in lengths] for _ in range(2))
        _, found, level = diagnostics.coherence(u, e, 0.02)
        assert level < 0.5
        below.append(np.mean(found < level))
    assert np.mean(below) == pytest.approx(0.95, abs=0.05)


def test_level_of_one_window_excludes_nothing():
    rng = np.random.default_rng(9)
    u, e = rng.standard_normal(8), rng.standard_normal(8)
    assert diagnostics.coherence([u], [e], 0.02)[2] == 1.0


def test_a_residual_of_zero_has_no_statement():
    zero = [np.zeros(500)]
    assert np.all(diagnostics.autocorrelation(zero, 5)[0] == 0.0)
    assert np.all(diagnostics.cross_correlation([np.arange(500.0)], zero, 3, 3)[0] == 0.0)
    assert np.all(diagnostics.coherence([np.arange(500.0)], zero, 0.01)[1] == 0.0)
