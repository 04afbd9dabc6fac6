# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tests that noise passes as rarely as they say, whatever its colour."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binomtest, kstest
from scipy.stats import f as f_distribution

from pam_ros.effects import EFFECTS
from pam_ros.identification import evidence
from pam_ros.identification.candidate import Fit
from pam_ros.identification.solve import Solution
from support.equations import coloured, equation, least_squares_fit, missing, unknown

N = 4000
T = np.linspace(0.0, 1.0, N)
PARENT = np.stack([np.ones(N), T, T**2], axis=1)
CHILD = np.column_stack([PARENT, np.sin(14.0 * T), np.cos(14.0 * T)])
RUNS = 300


def nested(values, independent):
    """Return the fits of *values* without and with two columns more."""
    return (
        least_squares_fit(PARENT, values, 'abc', independent),
        least_squares_fit(CHILD, values, 'abcde', independent),
    )


def p_values(rho, independent):
    """Return the p value of each of many records of nothing but noise."""
    rng = np.random.default_rng(7)
    return np.array(
        [evidence.f_test(*nested(coloured(rng, N, rho), independent)) for _ in range(RUNS)]
    )


def test_p_values_of_white_noise_are_uniform():
    p = p_values(0.0, float(N))
    # The residual's own correlation may lower the samples a little, never raise them.
    assert kstest(p, 'uniform').statistic < 0.15
    assert binomtest(int(np.sum(p < 0.01)), RUNS, 0.01, 'greater').pvalue > 0.001


@pytest.mark.parametrize('rho', [0.5, 0.9, 0.97])
def test_coloured_noise_passes_no_more_often_than_the_level_says(rho):
    p = p_values(rho, N * (1.0 - rho) / (1.0 + rho))
    assert binomtest(int(np.sum(p < 0.01)), RUNS, 0.01, 'greater').pvalue > 0.001
    assert binomtest(int(np.sum(p < 0.1)), RUNS, 0.1, 'greater').pvalue > 0.001
    # A test that never rejects would pass the above, too.
    assert np.mean(p < 0.5) > 0.2


def test_counting_every_sample_would_invent_effects():
    rng = np.random.default_rng(7)
    naive = 0
    for _ in range(50):
        parent, child = nested(coloured(rng, N, 0.9), float(N))
        left, whole = (float(f.solution.r @ f.solution.r) for f in (child, parent))
        ratio = (whole - left) / 2.0 / (left / (N - 5))
        naive += f_distribution.sf(ratio, 2, N - 5) < 0.01
    assert naive > 25


def test_f_test_by_hand():
    values = np.sin(14.0 * T) + coloured(np.random.default_rng(1), N, 0.0)
    parent, child = nested(values, 100.0)
    left, whole = (float(f.solution.r @ f.solution.r) for f in (child, parent))
    expected = f_distribution.sf((whole - left) / 2.0 / (left / 95.0), 2, 95.0)
    assert evidence.f_test(parent, child) == pytest.approx(expected, rel=1e-9)
    assert expected < 1e-6
    # A child that explains less proves nothing.
    assert evidence.f_test(parent, replace(child, solution=worse(child.solution))) == 1.0


def worse(solution):
    return replace(solution, r=solution.r * 3.0)


def test_samples_are_the_fewer_of_what_noise_and_residual_allow():
    rng = np.random.default_rng(3)
    white, slow = coloured(rng, N, 0.0), coloured(rng, N, 0.98)
    for values, said, low, high in (
        (white, 50.0, 50.0, 50.0),
        (white, float(N), 0.75 * N, N),
        (slow, float(N), evidence.LEAST, 3.0 * N * 0.02 / 1.98),
        (1e3 * T**3, float(N), evidence.LEAST, 1.5 * evidence.LEAST),
    ):
        fit = least_squares_fit(PARENT, values, 'abc', said)
        assert low <= evidence.independent_samples(fit) <= high


def test_holm_by_hand():
    # As R's p.adjust gives them.
    p = np.array([0.01, 0.04, 0.03, 0.005])
    np.testing.assert_allclose(evidence.holm(p), [0.03, 0.06, 0.06, 0.02])
    np.testing.assert_allclose(evidence.holm(np.array([0.4, 0.5, 0.001])), [0.8, 0.8, 0.003])
    np.testing.assert_allclose(evidence.holm(np.array([0.02])), [0.02])


def test_holm_keeps_the_level_of_the_family():
    rng = np.random.default_rng(4)
    families = [np.min(evidence.holm(rng.random(15))) < 0.05 for _ in range(4000)]
    assert np.mean(families) == pytest.approx(0.05, abs=0.012)


def strength_fit(effect, parameter, size):
    """Return a fit in which a strength is *size* standard errors from 0."""
    name = f'effects.{effect}.{parameter}'
    column = np.sin(14.0 * T) / np.sqrt(np.mean(np.sin(14.0 * T) ** 2))
    noise = coloured(np.random.default_rng(5), N, 0.0)
    columns = np.column_stack([PARENT, column])
    noise -= columns @ np.linalg.lstsq(columns, noise, rcond=None)[0]
    noise /= np.sqrt(np.mean(noise**2))
    error = np.sqrt(np.linalg.inv(columns.T @ columns)[3, 3])
    values = size * error * column + noise
    return least_squares_fit(columns, values, ('a', 'b', 'c', name), float(N), (effect,))


@pytest.mark.parametrize(
    ('effect', 'parameter', 'size', 'clear'),
    [
        ('viscous_friction', 'coefficient', 6.0, True),
        ('viscous_friction', 'coefficient', 1.0, False),
        ('viscous_friction', 'coefficient', -6.0, False),  # it would drive the load
        ('pressure_offset', 'offset', 6.0, True),
        ('pressure_offset', 'offset', -6.0, True),  # a regulator may err either way
        ('pressure_offset', 'offset', -1.0, False),
        ('coulomb_friction', 'presliding', 6.0, False),  # no strength: it says nothing
    ],
)
def test_a_strength_must_be_surely_there_and_of_its_sign(effect, parameter, size, clear):
    known = next(e for e in EFFECTS if e.name == effect)
    assert parameter in [p.name for p in known.parameters]
    assert evidence.strengths_clear(strength_fit(effect, parameter, size), 1.0) is clear


def test_only_the_newest_effect_counts():
    fit = strength_fit('viscous_friction', 'coefficient', 8.0)
    later = replace(fit, effects=('viscous_friction', 'coulomb_friction'))
    assert evidence.strengths_clear(fit, 1.0)
    assert not evidence.strengths_clear(later, 1.0)


def stop_fit(size):
    """Return a fit of a strength that only has to be large, like a stop's: at 0 it does much."""
    name = 'effects.end_stop.stiffness'
    noise = coloured(np.random.default_rng(5), N, 0.0)
    miss = np.sin(14.0 * T)

    def residuals(u):
        return noise + miss * np.exp(-(u[0] / 2.0))

    problem = equation(residuals, [unknown(name, 0.0, 1.0)], float(N))
    u = np.array([size])
    r = residuals(u)
    columns = ((residuals(u + 1e-3) - r) / 1e-3)[:, None]
    return Fit(('end_stop',), Solution(problem, u, r, columns, 1), 1.0, 1.0)


def test_what_is_beyond_doubt_needs_no_interval_but_its_sign_and_its_use():
    stiff = stop_fit(30.0)  # flat there: its standard error is without end
    assert not evidence.strengths_clear(stiff, 0.5)
    assert evidence.strengths_clear(stiff, 1e-9)
    assert not evidence.strengths_clear(stop_fit(-1e-3), 1e-9)
    # One that does nothing is not clear, however good the rest of its effect is.
    idle = strength_fit('viscous_friction', 'coefficient', 1.0)
    assert not evidence.strengths_clear(idle, 1e-9)


def kept_back(fit, miss):
    (segment,) = fit.solution.problem.segments
    return miss[~segment.fit]


def test_difference_over_the_samples_kept_back():
    miss = coloured(np.random.default_rng(6), 20_000, 0.0)
    a, b = missing(miss, 1.0), missing(miss, 1.1)
    kept_a, kept_b = kept_back(a, miss), kept_back(b, 1.1 * miss)
    mean, error = evidence.held_difference(a, b)
    assert mean == pytest.approx(np.mean(kept_b**2 - kept_a**2), rel=1e-9)
    # Of white noise every sample counts.
    plain = np.std(kept_b**2 - kept_a**2) / np.sqrt(kept_a.size)
    assert error == pytest.approx(plain, rel=0.1)
    back, _ = evidence.held_difference(b, a)
    assert back == pytest.approx(-mean)


def test_a_difference_of_coloured_residuals_is_less_certain():
    miss = coloured(np.random.default_rng(6), 20_000, 0.9)
    a, b = missing(miss, 1.0), missing(miss, 1.1)
    kept_a, kept_b = kept_back(a, miss), kept_back(b, 1.1 * miss)
    _, error = evidence.held_difference(a, b)
    plain = np.std(kept_b**2 - kept_a**2) / np.sqrt(kept_a.size)
    # The square of an AR(1) process at rho has a correlation of rho^2.
    assert error / plain == pytest.approx(np.sqrt((1 + 0.81) / (1 - 0.81)), rel=0.25)
