# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A search on recordings of the truth plant, which shares nothing with the package."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import ViscousFriction
from pam_ros.identification.data.parts import parts_of
from pam_ros.identification.search import search as search_module
from pam_ros.identification.search.criteria import CRITERIA
from pam_ros.identification.search.moves import absent_effects, with_each
from pam_ros.identification.search.search import (
    Search,
    find_effects,
    free_parameters,
    order_candidates,
    simplify,
)
from pam_ros.identification.search.setting import Errors
from pam_ros.identification.search.table import is_instead_of_constants
from pam_ros.identification.verdict import explains
from support import bench_truth
from support.marks import at_release
from support.searches import at_nominal, found_in, setting_of
from truth import effect

pytestmark = [pytest.mark.slow, pytest.mark.needs_numba]
OFF = np.array([0.02, -0.03, 0.01, -0.02, 0.01, 0.03])  # a specimen within its priors


@pytest.fixture
def searched(pool):
    """Return a function that searches recordings for what a model lacks."""

    def search(recordings, model=None, **shares):
        model = model or bench_truth.nominal(off=OFF)
        return find_effects(setting_of(recordings, pool, model, **shares))

    return search


@pytest.mark.parametrize(
    'there',
    [
        effect('viscous_friction'),
        at_release(effect('coulomb_friction')),
        at_release(effect('pressure_lag')),
        at_release(effect('creep', 'pressure')),
        at_release(effect('dead_time')),
    ],
    ids=lambda one: one.kind,
)
def test_the_effect_that_is_there_is_found_and_no_other(searched, there):
    found = searched([bench_truth.free(there, seed=3, duration=25.0)])
    assert found.best.effects == (there.kind,)
    assert explains(found)
    before, after = found.retuned.errors, found.best.errors
    assert after.fit < 0.5 * before.fit
    assert after.choose < 0.5 * before.choose


def valve(**values):
    """Return a lag by the flow through a valve, which depends on the pressures at it."""
    return effect('pressure_lag', 'iso_6358', **values)


@pytest.mark.parametrize(
    ('there', 'name'),
    [
        (valve(conductance_fill=2.0, conductance_vent=2.0, volume_l=0.1), 'pressure_lag'),
        (valve(conductance_fill=1.5, conductance_vent=0.6, volume_l=0.2), 'pressure_lag'),
        (effect('leak', 'closed_valve'), 'leak'),
        (effect('leak', 'refill'), 'leak'),  # its refill alone is explained by a freed lag
    ],
    ids=['fast_valve', 'slow_vent', 'closed_valve', 'refill'],
)
def test_a_broader_effect_and_the_simpler_one_are_compared_with_all_their_parameters(
    pool, there, name
):
    """The two time constants of a lag describe a valve worse than a leak with its refill does."""
    found = found_in([bench_truth.free(there, seed=21)], pool, name='leak')
    leak = free_parameters(found.best, found)
    assert simplify(leak, leak.effects, found).effects == (name,)


@pytest.fixture(scope='module')
def explained_by_leak(pool):
    """Return a search on a lag that is explained by a leak, the leak with all of it, and a lag."""
    found = found_in([bench_truth.free(effect('pressure_lag'), seed=21)], pool, name='leak')
    (lag, *_) = with_each(found.retuned, ['pressure_lag'], found.setting)
    return found, free_parameters(found.best, found), lag


@pytest.mark.parametrize('case', ['none', 'earlier', 'plain', 'with all', 'from the leak'])
def test_a_simpler_effect_counts_by_its_best_fit(explained_by_leak, monkeypatch, case):
    """The fits are given.

    One that starts near the broader effect can stop before an earlier one did; with additional
    parameters that are not needed, the free run may be worse than without; and a simpler effect
    that suffices gets those that it has alone, such as the flow of a valve.
    """
    whole, leak, lag = explained_by_leak
    found, wider = replace(whole, evaluated=[*whole.evaluated]), replace(lag)
    poor = replace(found.retuned, effects=('pressure_lag',))
    if case == 'earlier':
        found.evaluate([lag])
    direct, fits = [lag] * (case == 'from the leak'), [lag if case == 'plain' else poor]
    given = {
        'with_simpler_effect': lambda *given: direct,
        'is_sufficient': lambda *given: bool(direct),
        'within_tolerance': lambda one, *given: one in (lag, wider),
        'remove_effect': lambda *given: found.retuned,
        'with_each': lambda *given: fits,
        'free_parameters': lambda *given: wider if direct or case == 'with all' else poor,
    }
    for name, function in given.items():
        monkeypatch.setattr(search_module, name, function)
    expected = {'none': leak, 'earlier': lag, 'plain': lag}.get(case, wider)
    assert simplify(leak, leak.effects, found) is expected


@pytest.mark.parametrize('rho', [0.0, 0.95], ids=['white', 'coloured'])
def test_noise_is_no_effect(searched, rho):
    found = searched([bench_truth.free(seed=4, rho=rho)])
    assert found.best.effects == ()
    assert found.best.score <= min(model.score for model in found.evaluated) + CRITERIA.margin
    # Everything was tried.
    assert {m.effects for m in found.evaluated} == {
        (),
        *((name,) for name in absent_effects(found.best, found.setting)),
    }


def test_a_payload_that_retuning_hides_is_found_by_the_strain_of_the_constants(searched):
    model = bench_truth.nominal(mass=17.0)
    found = searched([bench_truth.free(seed=5, duration=40.0)], model)
    assert found.best.effects == ('payload',)
    assert found.best.errors.fit == pytest.approx(found.retuned.errors.fit, rel=0.02)
    assert found.retuned.strain > found.best.strain + CRITERIA.strain
    assert found.best.solution.value('effects.payload.mass') == pytest.approx(3.0, abs=0.3)
    assert is_instead_of_constants(found, 'payload')
    assert explains(found)


def test_creep_that_has_not_settled_when_the_recording_begins(searched):
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


@pytest.mark.release
def test_hysteresis_is_found_where_every_recording_falls_at_its_end_only(searched):
    """Whole recordings choose, so that fits see the way back; divided in time, creep was found."""
    there = effect('hysteresis', 'pressure')
    recordings = [bench_truth.step_and_back(there, seed=k) for k in range(6)]
    found = searched(recordings, fit=CRITERIA.fit / CRITERIA.choose, choose=1.0)
    assert found.best.effects == ('pressure_hysteresis',)
    assert explains(found)


def test_nothing_sees_what_judges(searched):
    """The last quarter may hold anything: the search is the same to the bit."""
    recording = bench_truth.free(effect('viscous_friction'), seed=7, duration=12.0)
    (part,) = parts_of([recording], CRITERIA.fit, CRITERIA.choose)
    spoiled = recording.position.copy()
    spoiled[part.judge] = np.random.default_rng(1).normal(0.05, 0.01, part.judge.sum())
    one, other = searched([recording]), searched([replace(recording, position=spoiled)])
    assert one.best.effects == other.best.effects
    np.testing.assert_array_equal(one.best.solution.u, other.best.solution.u)
    assert [m.score for m in one.evaluated] == [m.score for m in other.evaluated]


def test_an_effect_that_is_configured_is_not_tried(searched):
    model = bench_truth.nominal()
    known = replace(model, effects=[ViscousFriction(coefficient=60.0)])
    found = searched([bench_truth.free(effect('viscous_friction'), seed=3)], known)
    assert found.best.effects == ()
    assert 'viscous_friction' not in absent_effects(found.best, found.setting)
    assert explains(found)


@pytest.mark.release
def test_what_is_not_in_the_library_gets_no_name(searched):
    found = searched([bench_truth.free(effect('random_walk'), seed=8, duration=40.0)])
    assert not explains(found)


@pytest.mark.release
def test_an_effect_that_lowers_only_the_score_is_replaced_by_one_with_a_better_free_run(
    searched,
):
    """Viscous friction has the better score, and 1 % of the error, as long as creep is missing."""
    there = (effect('viscous_friction', viscous_ns_m=42.0), effect('creep', 'pressure'))
    found = searched([bench_truth.free(*there, seed=9, duration=60.0)])
    assert set(found.best.effects) == {'viscous_friction', 'creep'}


@pytest.mark.release
def test_a_strength_that_describes_most_of_another_effect_is_exchanged_for_it(searched):
    """A lag with a dead zone of its valve is better than a dead time or a narrow hysteresis alone.

    No effect that is added to it matters.
    """
    narrow = effect('hysteresis', 'pressure', hyst_pa=3540.0, hyst_reach_pa=36e3)
    there = (narrow, effect('dead_time', dead_time_s=0.024))
    found = searched([bench_truth.free(*there, seed=5, duration=60.0)])
    assert {*found.best.effects} == {'pressure_hysteresis', 'dead_time'}
    assert found.best.errors.choose < 1.2 * found.setting.noise


@pytest.mark.parametrize(('count', 'first'), [(1, 'softening'), (4, 'creep')])
def test_where_other_recordings_choose_the_nearest_free_run_leads(count, first, pool):
    """Scores and errors are given; a look leads to neither, and what does not pay comes last.

    The scores are lower than that of any fit, so that no model is fitted again.
    """
    recordings = [bench_truth.free(seed=k, name=f'{k}.csv') for k in range(count)]
    setting = setting_of(recordings, pool)
    place = at_nominal(setting.problem)

    def model(name, score, error, is_screened=False):
        found = setting.model((name,), replace(place), is_screened)
        # Both are computed once, when they are asked for first.
        found.solution.__dict__['score'] = score - 1e9
        found.__dict__['errors'] = Errors(error, error, error)
        return found

    best = model('', 0.0, 10.0)
    tried = [
        model('softening', -90.0, 5.0),
        model('leak', -80.0, 2.0, is_screened=True),
        model('creep', -70.0, 3.0),
        model('slack', -1.0, 1.0),
    ]
    order = [one.effects[0] for one in order_candidates(tried, Search(setting, best, best))]
    assert setting.is_crossed is (count == 4)
    # A gap at which *choose* begins leaves no stretch with both, and is no other recording.
    one = recordings[0]
    a, b = (int(share * one.t.size) for share in (0.5, 0.6))
    rows = np.r_[:a, b : one.t.size]
    gap = replace(
        one, t=one.t[rows], position=one.position[rows], gaps=((one.t[a - 1], one.t[b]),)
    )
    cut = parts_of([gap], CRITERIA.fit, CRITERIA.choose)
    assert not any(part.fit.any() and part.choose.any() for part in cut)
    assert not replace(setting, parts=cut).is_crossed
    assert order[0] == first
    assert order[2:] == (['creep', 'slack'] if count == 1 else ['leak', 'slack'])
