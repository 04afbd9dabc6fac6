# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The search: what counts as an effect, and that every step of it explains more, not less."""

import pytest

from pam_ros.effects import EFFECTS
from pam_ros.identification.data.noise import Noise, noise_of
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.selection import search
from pam_ros.rig.joint import changed
from support import bench_truth
from truth import effect

MODEL = bench_truth.declared(off=[0.01, -0.01, 0.0, 0.01, 0.0, 0.01])
KNOWN = {e.name: e for e in EFFECTS}
NOISE = Noise(0.01, 0.0)


def free_segments(*effects, **settings):
    recording = bench_truth.free(*effects, **{'duration': 12.0, 'seed': 3, **settings})
    return segments_of([recording], keep_back=True)


@pytest.fixture(scope='module', params=['viscous_friction', 'pressure_lag', 'none'])
def searched(request):
    """Return (name, the search, what progress was told) of a rig that lacks one effect or none."""
    effects = () if request.param == 'none' else (effect(request.param),)
    segments = free_segments(*effects, duration=20.0)
    noise = noise_of([(s.t, s.target) for s in segments])
    told = []
    found = search(MODEL, segments, noise, lambda share, text: told.append((share, text)))
    return request.param, found, told


@pytest.mark.slow
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


@pytest.mark.slow
@pytest.mark.needs_numba
def test_effects_that_are_declared_as_absent_are_tried():
    """A file of all parameters, such as ROS writes of a running node, declares all of them so."""
    absent = {e.name: {p.name: p.default for p in e.parameters} for e in EFFECTS}
    segments = free_segments(effect('viscous_friction'))
    found = search(changed(MODEL, MODEL.muscle, absent), segments, NOISE, lambda *_: None)
    assert found.augmented.effects == ('viscous_friction',)
    assert {t.effect.name for t in found.rounds[0]} == KNOWN.keys()
