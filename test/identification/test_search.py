# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The search: what counts as an effect, and that every step of it explains more, not less."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import EFFECTS
from pam_ros.identification import evidence
from pam_ros.identification.evidence import Evidence
from pam_ros.identification.noise import Noise, noise_of
from pam_ros.identification.search import Tried, admitted, only_starts, problem_of, search
from pam_ros.identification.segment import segments_of
from support import bench_truth
from support.equations import missing
from truth import effect

MODEL = bench_truth.declared(off=[0.01, -0.01, 0.0, 0.01, 0.0, 0.01])
KNOWN = {e.name: e for e in EFFECTS}
CLEAR = Evidence(p=1e-9, gain=0.5, interval_clear=True, absorbed=False)
SHAPE = np.sin(np.arange(2000) / 7.0)
NOISE = Noise(0.01, 0.0)


def fit_of(size, *effects):
    """Return a fit that leaves an error of about *size* times 0.7."""
    return missing(SHAPE, size, effects)


def tried(size, known=CLEAR, parents=()):
    return Tried(KNOWN['creep'], parents, fit_of(size, *parents, 'creep'), known, 0.0)


@pytest.mark.parametrize(
    ('changes', 'counts'),
    [
        ({}, True),
        ({'interval_clear': False}, False),
        ({'p': 1.01 * evidence.SIGNIFICANCE}, False),
        ({'gain': 0.99 * evidence.GAIN}, False),
        ({'gain': 0.0, 'absorbed': True}, True),
        ({'gain': 0.0, 'absorbed': True, 'p': 0.5}, False),
    ],
)
def test_a_first_effect_must_pass_every_test(changes, counts):
    one = tried(0.5, replace(CLEAR, **changes))
    assert admitted(one, fit_of(1.0), fit_of(1.0), NOISE) is counts


@pytest.mark.parametrize(
    ('left', 'counts'),
    [(0.1, True), (0.19, False), (0.98 * 0.2 * (1 - evidence.LATER_GAIN), True)],
)
def test_a_further_effect_must_explain_a_share_of_what_was_left(left, counts):
    # Re-tuning left 10, the first effect 0.2 of it: its own form may be that much off.
    parent = fit_of(0.2, 'leak')
    one = tried(left, CLEAR, ('leak',))
    assert admitted(one, parent, fit_of(10.0), NOISE) is counts


def free_segments(*effects, **settings):
    recording = bench_truth.free(*effects, **{'duration': 12.0, 'seed': 3, **settings})
    return segments_of([recording], keep_back=True)


def test_samples_that_were_thinned_are_less_alike():
    segments = free_segments()
    fitted = segments[0].fit.sum()
    for stride, rho in ((1, 0.8), (3, 0.8**3)):
        problem = problem_of(MODEL, segments, Noise(1e-5, 0.8), 5e-3, stride)
        assert problem.independent == pytest.approx(fitted * (1 - rho) / (1 + rho))
    names = [unknown.name for unknown in problem.unknowns]
    assert names == ['a1', 'a2', 'a3', 'a4', 'a5', 'a6', 'zeta', 'y0[0]', 'v0[0]']
    np.testing.assert_array_equal(problem.row, MODEL.row())


@pytest.mark.needs_numba
def test_the_declared_model_may_choose_its_start_and_nothing_else():
    problem = problem_of(MODEL, free_segments(), NOISE, 5e-3)
    wrong = np.zeros(9)
    wrong[7:] = 3.0, -2.0
    with ThreadPoolExecutor() as pool:
        solution = only_starts(problem, wrong, pool)
    assert not solution.u[:7].any()
    assert solution.cost < problem.cost(wrong, problem.residuals(wrong))
    np.testing.assert_allclose(
        solution.jacobian, problem.jacobian(solution.u, solution.r), rtol=1e-9, atol=1e-12
    )


@pytest.fixture(scope='module', params=['viscous_friction', 'pressure_lag', 'none'])
def searched(request):
    """Return (name, the search, what progress was told) of a rig that lacks one effect or none."""
    effects = () if request.param == 'none' else (effect(request.param),)
    segments = free_segments(*effects, duration=20.0)
    noise = noise_of([(s.t, s.target) for s in segments])
    told = []
    found = search(MODEL, segments, noise, lambda share, text: told.append((share, text)))
    return request.param, found, told


@pytest.mark.needs_numba
def test_the_effect_is_found_and_no_other(searched):
    name, found, _ = searched
    assert found.augmented.effects == (() if name == 'none' else (name,))
    chosen = [t.effect.name for row in found.rounds for t in row if t.chosen]
    assert set(found.augmented.effects) <= set(chosen)
    assert found.augmented.held_error < 1.2 * 20e-6


@pytest.mark.needs_numba
def test_no_model_of_the_search_ends_higher_than_the_one_it_came_from(searched):
    _, found, _ = searched
    assert found.retuned.solution.cost <= found.declared.solution.cost + 1e-6
    parent = found.retuned
    for row in found.rounds:
        for t in row:
            if t.chosen:
                assert t.fit.solution.cost < parent.solution.cost
                parent = t.fit
    assert found.augmented.score <= found.retuned.score


@pytest.mark.needs_numba
def test_candidates_stand_in_their_order_with_their_evidence(searched):
    _, found, _ = searched
    for row in found.rounds:
        assert [t.rank for t in row] == sorted(t.rank for t in row)
        names = [t.effect.name for t in row]
        assert len(set(names)) == len(names)
        assert all(0.0 <= t.evidence.p <= 1.0 for t in row)
        assert all(t.fit.effects == (*t.parents, t.effect.name) for t in row)
        assert sum(t.chosen for t in row) <= 1


@pytest.mark.needs_numba
def test_progress_goes_forward(searched):
    _, _, told = searched
    shares = [share for share, _ in told]
    assert shares == sorted(shares)
    assert 0.0 <= shares[0] < shares[-1] <= 1.0
    assert all(text for _, text in told)
