# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the residual plots draw, checked on the numbers in their lines."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.data.noise import Noise
from pam_ros.identification.wording import Scale
from pam_ros.report import residual_plots, style
from pam_ros.report.runs import Run
from pam_ros.report.time_plots import Curve

BOTH = [Curve(1, 're-tuned'), Curve(2, 'last')]
MM = Scale(1e3, 'mm')
KPA = Scale(1e-3, 'kPa')


def run_with(residual, pressure, rate=100.0):
    """Return a run whose last model leaves nothing and the one before *residual*."""
    t = np.arange(residual.size) / rate
    y = 0.05 + 0.01 * np.sin(t)
    return Run(
        'run', t, y, (y, y - residual, y.copy()), t > 5.0, False,
        pressure[:, None], y, np.gradient(y, t), pressure,
    )  # fmt: skip


@pytest.fixture
def loop_run():
    """Return a run under a triangle, with a residual of opposite sign up and down."""
    t = np.arange(4000) / 100.0
    p = 3e5 + 2e5 * (2.0 * np.abs((t / 20.0) % 1.0 - 0.5))
    return run_with(1e-3 * np.sign(np.gradient(p)), p)


def lines(figure):
    return [line for line in figure.axes[0].lines if len(line.get_xdata()) > 2]


def test_bins_hold_equally_many_and_give_mean_and_quantiles():
    rng = np.random.default_rng(0)
    x = rng.uniform(0.0, 1.0, 36_000)
    e = 3.0 * x + rng.standard_normal(x.size)
    at, mean, low, high = residual_plots.binned(x, e, 36)
    assert at.size == 36
    assert mean == pytest.approx(3.0 * at, abs=0.15)
    # The 10 % and 90 % quantiles of a unit normal.
    assert (high - mean) == pytest.approx(1.2816, abs=0.15)
    assert (mean - low) == pytest.approx(1.2816, abs=0.15)


def test_levels_get_a_bin_each():
    x = np.repeat([0.0, 1.0, 2.0, 3.0], 500)
    at, mean, _, _ = residual_plots.binned(x, x**2, 36)
    assert at[-3:].tolist() == [1.0, 2.0, 3.0]
    assert mean[-3:].tolist() == [1.0, 4.0, 9.0]


def test_rising_and_falling_are_distinguished(loop_run):
    with style.styled():
        figure = residual_plots.by_direction([loop_run], BOTH, MM, KPA, 'pressure, kPa')
    up, down = lines(figure)[:2]
    assert np.median(up.get_ydata()) == pytest.approx(1.0, abs=0.01)
    assert np.median(down.get_ydata()) == pytest.approx(-1.0, abs=0.01)
    assert (up.get_marker(), down.get_marker()) == ('^', 'v')
    assert up.get_linestyle() == down.get_linestyle()  # that of the model
    assert np.ptp(up.get_xdata()) > 150.0


def test_loop_is_the_calm_one(loop_run):
    rng = np.random.default_rng(1)
    steps = np.repeat(rng.uniform(1e5, 6e5, 40), 100)
    both = replace(loop_run, drive=np.where(loop_run.t < 20.0, loop_run.drive, steps))
    stretch = residual_plots.loop_stretch([both])
    t = both.t[stretch.start : stretch.stop]
    assert t[-1] <= 20.0
    assert np.ptp(both.drive[stretch.start : stretch.stop]) == pytest.approx(2e5, rel=0.1)


def test_residual_over_velocity_shows_a_jump():
    t = np.arange(8000) / 200.0
    y = 0.05 + 0.02 * np.sin(t)
    v = np.gradient(y, t)
    run = Run('run', t, y, (y, y - 2e-3 * np.sign(v), y), t < 0, False, y[:, None], y, v, y)
    with style.styled():
        figure = residual_plots.against([run], BOTH, MM, lambda r: 1e3 * r.velocity, 'v')
    before, after = lines(figure)[:2]
    assert before.get_ydata()[0] == pytest.approx(-2.0, abs=0.01)
    assert before.get_ydata()[-1] == pytest.approx(2.0, abs=0.01)
    assert after.get_ydata() == pytest.approx(0.0, abs=1e-9)


def test_spectrum_carries_the_noise_floor():
    rng = np.random.default_rng(2)
    e = 1e-4 * rng.standard_normal(20_000)
    run = run_with(e, 3e5 + 1e5 * np.sin(np.arange(20_000) / 300.0))
    with style.styled():
        figure = residual_plots.spectrum([run], BOTH[:1], MM, Noise(1e-4, 0.0))
    density, floor = lines(figure)
    # White: 2 sigma^2 over the sampling rate of 100 Hz.
    assert floor.get_ydata() == pytest.approx(0.1 * np.sqrt(2.0 / 100.0))
    assert np.median(density.get_ydata()) == pytest.approx(0.1 * np.sqrt(0.02), rel=0.1)


def test_autocorrelation_has_its_lags_in_seconds(loop_run):
    with style.styled():
        figure = residual_plots.autocorrelation([loop_run], BOTH[:1])
    (line,) = lines(figure)
    assert line.get_xdata()[-1] == pytest.approx(2.0)
    assert line.get_ydata()[0] == 1.0
    # A square wave that turns three times in 40 s: of 38 s, 2 s around each turn do not agree.
    assert line.get_ydata()[-1] == pytest.approx((38.0 - 2.0 * 6.0) / 40.0, abs=0.01)


def test_coherence_has_its_band_also_for_a_short_run():
    rng = np.random.default_rng(3)
    run = run_with(1e-4 * rng.standard_normal(600), 3e5 + 1e5 * rng.standard_normal(600))
    with style.styled():
        figure = residual_plots.coherence([run], BOTH[:1])
    (band,) = figure.axes[0].patches
    assert 0.2 < band.get_extents().transformed(figure.axes[0].transData.inverted()).y1 < 0.5
