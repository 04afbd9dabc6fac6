# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of one length that drift apart, on forces in closed form."""

import numpy as np
import pytest

from pam_ros.identification.candidate import fitted
from pam_ros.identification.data.noise import Noise
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.drift import drifts, shares
from pam_ros.identification.finder import trace
from pam_ros.identification.retuning import problem_of
from pam_ros.identification.solve import solve
from pam_ros.recording.recording import Recording
from support import bench_truth
from truth.muscles import constants_si

pytestmark = pytest.mark.needs_numba
NOISE = 2.0  # N
LENGTH = 0.4  # m


def repeat(zero, kappa=0.05, seed=0, moving=0.0):
    """Return a recording of the declared muscle's force at a length, *zero* N too high."""
    rng = np.random.default_rng([seed, round(1e6 * kappa)])
    t = np.arange(2000) / 100.0
    p = 3e5 - 2e5 * np.cos(2.0 * np.pi * t / 10.0)
    k = kappa + moving * np.sin(2.0 * np.pi * t / 7.0)
    a1, a2, a3, a4, a5, a6 = constants_si('dmsp_20_400n')
    force = (a1 * p + a2) * np.exp(a3 * k) + a4 * k * p + a5 * p + a6
    force += zero + NOISE * rng.standard_normal(t.size)
    return Recording('held.csv', t, None, None, k * LENGTH, None, force, p, 'held')


def as_declared(*recordings):
    """Return the fit of nothing to *recordings*."""
    model = bench_truth.declared()
    segments = segments_of(recordings, keep_back=True)
    problem = problem_of(model, segments, Noise(NOISE, 0.0), 1e-3)
    return fitted((), solve(problem, np.zeros(len(problem.unknowns)), 0))


def level_of(fit):
    """Return what the declared muscle is off by: its weight stands in a6."""
    return float(bench_truth.declared().muscle.si[5] - constants_si('dmsp_20_400n')[5])


def test_runs_of_one_length_that_drift_count_by_how_late_they_are():
    fit = as_declared(
        repeat(9.0), repeat(0.0, 0.1), repeat(4.0, seed=1), repeat(20.0, 0.1), repeat(2.0, seed=2)
    )
    first, second = drifts(fit, NOISE)
    assert (first.runs, second.runs) == ((0, 2, 4), (1, 3))
    assert (first.kappa, second.kappa) == pytest.approx((0.05, 0.1))
    np.testing.assert_allclose(first.levels + level_of(fit), [9.0, 4.0, 2.0], atol=0.3)
    np.testing.assert_allclose(
        shares([first, second], 5), [3 / 21, 2 / 5, 12 / 21, 8 / 5, 48 / 21], rtol=1e-12
    )


def test_the_last_run_does_not_decide_where_it_slipped():
    fit = as_declared(repeat(4.0), repeat(1.0, seed=1), repeat(0.0, seed=2), repeat(40.0, seed=3))
    (drift,) = drifts(fit, NOISE)
    assert drift.last_slipped
    np.testing.assert_allclose(drift.shares * 22.0 / 4.0, [1.0, 4.0, 16.0, 1.0], rtol=1e-12)
    assert 'slipped' in str(drift)


@pytest.mark.parametrize(
    'recordings',
    [
        [repeat(0.0), repeat(1.0, seed=1)],
        [repeat(0.0), repeat(30.0, 0.06)],
        [repeat(0.0, moving=0.02), repeat(30.0, moving=0.02)],
        [bench_truth.free(duration=10.0), bench_truth.free(duration=10.0, seed=1)],
    ],
    ids=['within the noise', 'other lengths', 'moving', 'free'],
)
def test_all_others_count_alike(recordings):
    fit = as_declared(*recordings)
    assert drifts(fit, NOISE) == []
    assert shares([], len(recordings)) == ()


@pytest.mark.slow
def test_what_comes_next_is_foretold_by_the_last_of_them():
    settling = [repeat(27.0 * 3.0**-k, seed=k) for k in range(4)]
    found = trace(bench_truth.declared(), settling[:3], settling[3:])
    # Fitted alike, the runs of 27, 9 and 3 N would leave some 12 N of the fourth, of 1 N.
    assert found.stages[1].held_error < 6.5
    (told,) = found.warnings
    start, rest = told.split(' differ by ')
    assert start == 'the recordings at 5 % contraction'
    assert float(rest.split(' N')[0]) == pytest.approx(27.0 - 3.0, abs=0.5)
    assert told.endswith('the last one counts most')
