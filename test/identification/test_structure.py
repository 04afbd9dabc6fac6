# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a generic regressor can say of residuals of which the truth is known."""

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.stats import chi2

from pam_ros.identification.structure import ljung_box, structure_of
from support.equations import coloured

RATE = 200.0
T = np.arange(round(60.0 * RATE)) / RATE


def inputs(seed=0):
    """Return pressure, position and velocity of a load that is shaken in many ways."""
    rng = np.random.default_rng(seed)
    p = 3e5 + sum(
        3e4 * np.sin(2 * np.pi * f * T + rng.uniform(0, 6)) for f in (0.13, 0.41, 0.9, 2.3)
    )
    y = 0.04 + 1e-7 * lfilter([0.05], [1.0, -0.95], p - 3e5)
    return p, y, np.gradient(y, T)


@pytest.mark.parametrize('rho', [0.0, 0.9, 0.99])
def test_noise_that_the_input_does_not_cause_has_no_structure(rho):
    ceilings = [
        structure_of(T, coloured(np.random.default_rng(s), T.size, rho), inputs(s), 1.0).ceiling
        for s in range(4)
    ]
    assert max(ceilings) < 0.05


@pytest.mark.parametrize(
    'term',
    [
        lambda p, y, v: (p - 3e5) / 4e4,
        lambda p, y, v: np.tanh(v / 1e-3),
        lambda p, y, v: (p - 3e5) / 4e4 * np.sign(v),
        lambda p, y, v: ((y - y.mean()) / y.std()) ** 2,
        lambda p, y, v: np.roll((p - 3e5) / 4e4, round(0.2 * RATE)),
    ],
    ids=['pressure', 'friction', 'loop', 'curvature', 'late'],
)
def test_what_the_input_causes_is_seen(term):
    signals = inputs()
    caused = term(*signals)
    noise = coloured(np.random.default_rng(1), T.size, 0.3, 0.2)
    found = structure_of(T, caused + noise, signals, 0.2)
    assert found.ceiling > 0.7
    assert found.share == pytest.approx(1.0 - 0.2**2 / np.mean((caused + noise) ** 2), abs=1e-9)


def test_a_drift_is_seen_although_its_ends_lie_outside_what_was_learnt():
    noise = coloured(np.random.default_rng(1), T.size, 0.3, 0.2)
    assert structure_of(T, T / 30.0 - 1.0 + noise, inputs(), 0.2).ceiling > 0.4


def test_half_the_variance_is_half_a_ceiling():
    signals = inputs()
    caused = (signals[0] - 3e5) / np.std(signals[0])
    # Noise of the rate at which the regressor looks, so that no averaging removes it.
    noise = np.repeat(np.random.default_rng(2).standard_normal(T.size // 4), 4)
    assert structure_of(T, caused + noise, signals, 0.0).ceiling == pytest.approx(0.5, abs=0.06)


def test_scales_do_not_matter():
    p, y, v = inputs()
    e = np.tanh(v / 1e-3) + coloured(np.random.default_rng(3), T.size, 0.0)
    one = structure_of(T, e, (p, y, v), 1.0)
    other = structure_of(T + 100.0, 1e-3 * e, (1e-5 * p, 1e3 * y, 1e3 * v), 1e-3)
    assert other.ceiling == pytest.approx(one.ceiling, abs=1e-6)
    assert other.share == pytest.approx(one.share, abs=1e-9)


def test_share_is_nothing_below_the_floor():
    e = coloured(np.random.default_rng(4), T.size, 0.0)
    assert structure_of(T, e, inputs(), 1.5).share == 0.0
    silent = structure_of(T, np.zeros(T.size), inputs(), 1.0)
    assert (silent.ceiling, silent.share, silent.whiteness) == (0.0, 0.0, 1.0)


def test_a_short_record_cannot_tell():
    short = slice(0, 300)
    p, y, v = (s[short] for s in inputs())
    assert structure_of(T[short], (p - 3e5) / 4e4, (p, y, v), 0.0).ceiling == 0.0


def test_ljung_box_by_hand():
    e = coloured(np.random.default_rng(5), 500, 0.1) + 7.0
    d = e - e.mean()
    n, lags, total = d.size, 20, 0.0
    for k in range(1, lags + 1):
        r = sum(d[i] * d[i - k] for i in range(k, n)) / sum(x * x for x in d)
        total += r * r / (n - k)
    expected = chi2.sf(n * (n + 2) * total, lags)
    assert 1e-6 < expected < 0.9
    assert ljung_box(e) == pytest.approx(expected, rel=1e-9)


def test_ljung_box_of_what_cannot_be_tested():
    assert ljung_box(np.ones(100)) == 1.0
    assert ljung_box(np.arange(10.0)) == 1.0
