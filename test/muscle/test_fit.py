# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fits of static maps: known constants, the maker's curves, measured maps."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import curve_fit

from pam_ros.errors import ParameterError
from pam_ros.muscle.fit import fit_static_map

TRUE = np.array([-4.35573, 281.22370, -0.32866, -9.27035, 302.20107, -263.69185])  # bar, percent
P, KAPPA = np.meshgrid(np.arange(0.0, 6.1, 0.5), np.arange(-2.0, 26.0, 2.0))
# The DMSP-20 fitted to its data sheet, contraction >= 0 (docs/model.md).
PRINTED = np.array([-13.28753, 274.69509, -0.26707, -8.10079, 266.25842, -276.47848])


def law(p, kappa, a1, a2, a3, a4, a5, a6):
    """Equation (1) once more, independent of the package."""
    return (a1 * p + a2) * np.exp(a3 * kappa) + a4 * kappa * p + a5 * p + a6


F = law(P, KAPPA, *TRUE)


def columns(folder, name, *names):
    table = np.genfromtxt(folder / name, delimiter=',', names=True)
    return [table[n] for n in names]


def data_sheet(folder, size):
    p, kappa, force = columns(
        folder,
        f'festo_dmsp{size}_datasheet_points.csv',
        'pressure_kPa',
        'contraction_fraction',
        'force_N',
    )
    some = kappa >= 0.0
    return p[some] / 100.0, 100.0 * kappa[some], force[some]


def test_a_map_without_noise_gives_its_constants_back():
    fit = fit_static_map(P, KAPPA, F, 'bar', 'percent')
    np.testing.assert_allclose(fit.constants, TRUE, rtol=1e-6)
    assert fit.rmse < 1e-5
    assert fit.points == F.size
    assert fit.slack_points == 0


def test_constants_come_in_the_units_of_the_map():
    si = fit_static_map(P * 1e5, KAPPA / 100.0, F)
    expected = TRUE * np.array([1e-5, 1.0, 100.0, 1e-3, 1e-5, 1.0])
    np.testing.assert_allclose(si.constants, expected, rtol=1e-6)
    kpa = fit_static_map(P * 100.0, KAPPA, F, 'kPa', 'percent').muscle(l0=0.4)
    np.testing.assert_allclose(kpa.si, expected, rtol=1e-6)
    assert (kpa.pressure_unit, kpa.contraction_unit) == ('kPa', 'percent')


@settings(max_examples=25, deadline=None)
@given(st.floats(0.5, 2.0), st.floats(0.3, 3.0), st.floats(0.5, 2.0))
def test_any_muscle_is_found_without_starting_values(stiffer, stronger, longer):
    a1, a2, _, a4, a5, a6 = TRUE * stronger
    true = (a1, a2, TRUE[2] * stiffer, a4 / longer, a5, a6)
    fit = fit_static_map(P, KAPPA, law(P, KAPPA, *true), 'bar', 'percent')
    np.testing.assert_allclose(fit.constants, true, rtol=1e-5)


def noisy(rng, slack):
    force = F + 5.0 * rng.standard_normal(F.shape)
    return np.maximum(force, 0.0) if slack else force


@pytest.mark.slow
@pytest.mark.parametrize(
    'how', [{}, {'slack_at': 0.0}, {'slack_at': 0.0, 'slack': 'excluded'}], ids=str
)
def test_standard_errors_cover_the_truth(how):
    """200 maps with 5 N of noise: z = (fitted - true) / standard error has mean 0, spread 1."""
    rng = np.random.default_rng(20)
    z, runs = [], 200
    for _ in range(runs):
        fit = fit_static_map(P, KAPPA, noisy(rng, bool(how)), 'bar', 'percent', **how)
        z.append((np.array(fit.constants) - TRUE) / fit.standard_errors)
    # Leaving noisy zeros out picks the lucky readings and biases by a fraction of an error.
    bias = 0.4 if how.get('slack') == 'excluded' else 4.0 / np.sqrt(runs)
    np.testing.assert_allclose(np.mean(z, axis=0), 0.0, atol=bias)
    np.testing.assert_allclose(np.std(z, axis=0), 1.0, atol=4.0 / np.sqrt(2.0 * runs))
    within = np.mean(np.abs(z) < 1.97, axis=0)  # 95 % of a t distribution of 130 degrees
    assert np.all((within > 0.89) & (within < 0.995))


def test_agrees_with_a_general_least_squares_solver():
    force = noisy(np.random.default_rng(3), slack=False)
    fit = fit_static_map(P, KAPPA, force, 'bar', 'percent')

    def flat(x, *a):
        return law(*x, *a)

    x = np.stack([P.ravel(), KAPPA.ravel()])
    found, covariance = curve_fit(flat, x, force.ravel(), p0=TRUE, xtol=1e-14, ftol=1e-14)
    np.testing.assert_allclose(fit.constants, found, rtol=1e-5)
    np.testing.assert_allclose(fit.covariance, covariance, rtol=1e-3)
    np.testing.assert_allclose(fit.residuals, force - law(P, KAPPA, *found), atol=1e-4)
    np.testing.assert_allclose(fit.standard_errors, np.sqrt(np.diag(fit.covariance)))


def test_censoring_uses_the_information_of_slack():
    """A pull at one or two contractions a pressure: that the rest is slack says a lot."""
    some = P <= 2.0
    force = noisy(np.random.default_rng(8), slack=True)[some]
    where = P[some], KAPPA[some], force, 'bar', 'percent'
    censored = fit_static_map(*where, slack_at=0.0)
    excluded = fit_static_map(*where, slack_at=0.0, slack='excluded')
    assert censored.slack_points == excluded.slack_points == np.count_nonzero(force <= 0.0)
    assert censored.points == np.count_nonzero(force > 0.0)
    assert np.array_equal(np.isnan(censored.residuals), force <= 0.0)
    assert np.all(np.array(censored.standard_errors) < np.array(excluded.standard_errors))


def test_data_sheet_of_the_dmsp_20(shared_data):
    fit = fit_static_map(*data_sheet(shared_data, 20), 'bar', 'percent')
    assert fit.points == 44
    assert fit.rmse <= 6.8
    np.testing.assert_allclose(fit.constants, PRINTED, rtol=5e-6)
    assert np.all(np.abs(np.array(fit.constants) - PRINTED) < 1e-3 * np.array(fit.standard_errors))
    assert fit.muscle(l0=0.4).equilibrium(6e5, 196.2) == pytest.approx(0.2315, abs=5e-4)


@pytest.mark.parametrize(('size', 'rmse', 'force_max'), [(10, 1.3, 630.0), (40, 25.0, 6000.0)])
def test_data_sheets_of_the_other_sizes(shared_data, size, rmse, force_max):
    p, kappa, force = data_sheet(shared_data, size)
    fit = fit_static_map(p, kappa, force, 'bar', 'percent')
    assert fit.rmse <= rmse
    muscle = fit.muscle(force_max=force_max, kappa_min=0.0, kappa_max=0.2)
    np.testing.assert_allclose(
        muscle.force(p * 1e5, kappa / 100.0), force - fit.residuals, atol=1e-8
    )


@pytest.mark.parametrize(
    ('name', 'l0', 'limits', 'rmse', 'clipped'),
    [
        ('martens_dmsp20_300_measured.csv', 0.3, (600e3, 0.25, 1500.0), 6.3, 4.4),
        ('martens_dmsp10_250_measured.csv', 0.25, (800e3, 0.2, 630.0), 1.4, 1.4),
    ],
)
def test_measured_maps_with_slack(shared_data, name, l0, limits, rmse, clipped):
    p, length, force = columns(shared_data, name, 'pressure_kPa', 'length_m', 'force_N')
    kappa = 1.0 - length / l0
    fit = fit_static_map(p, kappa, force, 'kPa', slack_at=0.0)
    assert fit.slack_points == np.count_nonzero(force == 0.0) > 0
    assert fit.rmse <= rmse
    p_max, kappa_max, force_max = limits
    muscle = fit.muscle(
        l0=l0, p_max=p_max, kappa_min=0.0, kappa_max=kappa_max, force_max=force_max
    )
    # A muscle that cannot push: the whole map, slack points included.
    error = np.maximum(muscle.force(p * 1e3, kappa), 0.0) - force
    assert np.sqrt(np.mean(error**2)) <= clipped


SIX = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
MEASURED = law(P, KAPPA, 11.5, 421.0, -0.562, -8.72, 268.0, -311.0)  # a DMSP-20-300
SHORTENED = tuple(a[KAPPA >= 2.0] for a in (P, KAPPA, np.maximum(MEASURED, 0.0)))
REFUSED = [
    ((P, KAPPA[:-1], F), {}, 'p, kappa and force must have one shape, not (14, 13), (13, 13), '),
    (
        (P, KAPPA, np.where(F > 900.0, np.nan, F)),
        {},
        '] = nan is not allowed: give finite numbers',
    ),
    ((P, KAPPA, F), {'pressure_unit': 'psi'}, "pressure_unit = 'psi' is not known: give one of "),
    ((P, KAPPA, F), {'contraction_unit': 'mm'}, "contraction_unit = 'mm' is not known"),
    ((P, KAPPA, F), {'slack': 'no'}, "slack = 'no' is not known: give one of censored, excluded"),
    ((SIX, SIX, SIX), {}, '6 measured points do not determine six constants and the noise'),
    ((P, KAPPA, 0.0 * F), {'slack_at': 0.0}, '0 measured points do not determine six constants'),
    ((P, KAPPA, 500.0 - 10.0 * KAPPA), {}, 'the map does not determine'),
    ((0.0 * P + 3.0, KAPPA, law(3.0, KAPPA, *TRUE)), {}, 'the map does not determine the six con'),
    ((P[:2], KAPPA[:2], F[:2]), {}, 'the map does not determine'),
    (SHORTENED, {}, '(63 readings of 0 N: if the muscle is slack there, give slack_at=0)'),
]


@pytest.mark.parametrize(('arrays', 'options', 'sentence'), REFUSED)
def test_maps_that_determine_nothing_are_refused_with_a_sentence(arrays, options, sentence):
    with pytest.raises(ParameterError) as error:
        fit_static_map(*arrays, **options)
    assert sentence in str(error.value)
