# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A search on recordings of the truth plant, which shares nothing with the package."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.data.parts import parts_of
from pam_ros.identification.search.criteria import BUDGET, CRITERIA
from pam_ros.identification.search.search import absent, search
from pam_ros.identification.search.setting import Setting
from pam_ros.identification.search.verdict import explains
from support import bench_truth
from truth import effect

pytestmark = [pytest.mark.slow, pytest.mark.needs_numba]
OFF = np.array([0.02, -0.03, 0.01, -0.02, 0.01, 0.03])  # a specimen within its priors


def searched(recordings, model=None):
    """Return the search of recordings for what *model* lacks."""
    model = model or bench_truth.declared(off=OFF)
    parts = parts_of(recordings, CRITERIA.fit, CRITERIA.choose)
    with ThreadPoolExecutor() as pool:
        return search(Setting(model, parts, CRITERIA, BUDGET, pool))


@pytest.mark.parametrize(
    'there',
    [
        effect('viscous_friction'),
        effect('coulomb_friction'),
        *(
            pytest.param(one, marks=pytest.mark.release)
            for one in (effect('pressure_lag'), effect('creep', 'pressure'), effect('dead_time'))
        ),
    ],
    ids=lambda one: one.kind,
)
def test_the_effect_that_is_there_is_found_and_no_other(there):
    found = searched([bench_truth.free(there, seed=3, duration=25.0)])
    assert found.best.effects == (there.kind,)
    assert explains(found)
    before, after = found.retuned.errors, found.best.errors
    assert after.fit < 0.5 * before.fit
    assert after.choose < 0.5 * before.choose


@pytest.mark.parametrize('rho', [0.0, 0.95], ids=['white', 'coloured'])
def test_noise_is_no_effect(rho):
    found = searched([bench_truth.free(seed=4, rho=rho)])
    assert found.best.effects == ()
    assert found.best.score <= min(model.score for model in found.looked_at) + CRITERIA.margin
    # Everything was tried.
    assert {m.effects for m in found.looked_at} == {
        (),
        *((name,) for name in absent(found.best, found.setting)),
    }


def test_a_payload_that_retuning_hides_is_found_by_the_strain_of_the_constants():
    model = bench_truth.declared(mass=17.0)
    found = searched([bench_truth.free(seed=5, duration=40.0)], model)
    assert found.best.effects == ('payload',)
    assert found.best.errors.fit == pytest.approx(found.retuned.errors.fit, rel=0.02)
    assert found.retuned.strain > found.best.strain + CRITERIA.strain
    assert found.best.solution.value('effects.payload.mass') == pytest.approx(3.0, abs=0.3)
    assert explains(found)


def test_creep_that_has_not_settled_when_the_recording_begins():
    """It was on its way when the first sample came: 12 s of motion before are cut off."""
    whole = bench_truth.free(effect('creep', 'strain'), seed=6, duration=60.0)
    late = whole.t >= 12.0
    part = replace(
        whole,
        t=whole.t[late],
        position=whole.position[late],
        command_t=whole.t[late],
        command=whole.command[late],
    )
    found = searched([part])
    assert found.best.effects == ('creep',)
    assert found.best.errors.fit < 1.2 * found.setting.noise


def test_nothing_sees_what_judges():
    """The last quarter may hold anything: the search is the same to the bit."""
    recording = bench_truth.free(effect('viscous_friction'), seed=7, duration=12.0)
    (part,) = parts_of([recording], CRITERIA.fit, CRITERIA.choose)
    spoiled = recording.position.copy()
    spoiled[part.judge] = np.random.default_rng(1).normal(0.05, 0.01, part.judge.sum())
    one, other = searched([recording]), searched([replace(recording, position=spoiled)])
    assert one.best.effects == other.best.effects
    np.testing.assert_array_equal(one.best.solution.u, other.best.solution.u)
    assert [m.score for m in one.looked_at] == [m.score for m in other.looked_at]


def test_an_effect_that_is_declared_is_not_tried():
    model = bench_truth.declared()
    known = replace(model, effects={'viscous_friction': {'coefficient': 60.0}})
    found = searched([bench_truth.free(effect('viscous_friction'), seed=3)], known)
    assert found.best.effects == ()
    assert 'viscous_friction' not in absent(found.best, found.setting)
    assert explains(found)


@pytest.mark.release
def test_what_is_not_in_the_library_gets_no_name():
    found = searched([bench_truth.free(effect('random_walk'), seed=8, duration=40.0)])
    assert not explains(found)
