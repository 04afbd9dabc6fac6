# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Models with an effect more, with more of it, with another in its place, and with one less."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.fit.extend import finer_starts
from pam_ros.identification.fit.solve import converge, initial_solution
from pam_ros.identification.fit.unknowns import parameters_of
from pam_ros.identification.search import moves
from pam_ros.identification.search.criteria import BUDGET, CRITERIA
from pam_ros.identification.search.moves import (
    remove_effect,
    with_each,
    with_fewer_parameters,
    with_fewer_strengths,
    with_more_parameters,
    with_simpler_effect,
    without_idle_parameters,
)
from pam_ros.identification.search.search import (
    Search,
    accepted,
    alternatives,
    confirm,
    exchange_effect,
)
from pam_ros.identification.search.starts import extended

pytestmark = [pytest.mark.slow, pytest.mark.needs_numba]
NAMES = ['pressure_lag', 'dead_time', 'viscous_friction']


@pytest.fixture(scope='module')
def tried(retuned, setting):
    return with_each(retuned, NAMES, setting)


def test_each_effect_is_tried_once_and_the_right_one_is_best(tried, retuned):
    assert sorted(m.effects for m in tried) == sorted((name,) for name in NAMES)
    assert tried[0].effects == ('pressure_lag',)
    assert [m.score for m in tried] == sorted(m.score for m in tried)
    assert tried[0].score < retuned.score - 1000.0
    assert tried[0].solution.value('effects.pressure_lag.fill') == pytest.approx(0.05, rel=0.02)


def test_the_best_is_fitted_to_its_end_however_short_the_others_are(retuned, setting):
    """Under a slow discrepancy fits go on for many iterations, and no score before is final."""
    short = replace(setting, budget=replace(BUDGET, closer=1))
    best = with_each(retuned, NAMES, short)[0]
    assert best.effects == ('pressure_lag',)
    assert best.score - converge(best.solution, 100).score < 0.1


def test_where_nothing_is_left_to_try_nothing_is_tried(retuned, setting, monkeypatch):
    assert with_each(retuned, [], setting) == []
    monkeypatch.setattr(moves, 'screen', lambda *rest: [])  # no start, such as no frequency
    assert with_each(retuned, ['periodic_disturbance'], setting) == []


def test_what_was_added_can_be_dropped(tried, retuned, setting):
    less = remove_effect(tried[0], 'pressure_lag', setting)
    assert less.effects == ()
    assert less.score <= retuned.score + 1.0
    assert remove_effect(tried[0], 'pressure_lag', setting) is less  # which is fitted once
    assert not [k for k in less.solution.problem.unknowns if k.name.startswith('effects')]


def test_the_best_of_the_finer_ones_is_fitted_to_its_end(tried, setting):
    short = replace(setting, budget=replace(BUDGET, closer=1))
    wider = with_more_parameters(tried[0], short)
    assert wider[0].score - converge(wider[0].solution, 100).score < 0.1
    for model in wider:
        assert model.effects == ('pressure_lag',)
        assert len(model.solution.u) > len(tried[0].solution.u)


def test_errors_are_computed_on_request(tried):
    model = replace(tried[-1])
    assert 'errors' not in vars(model)
    assert model.errors.fit > tried[0].errors.fit
    assert 'errors' in vars(model)


def test_a_fit_that_stopped_with_a_slow_discrepancy_continues_from_the_nearest_run(
    tried, retuned, setting
):
    """Its score is lower there, and the model of the better fit takes its place."""
    best = tried[0]
    problem, u = best.solution.problem, best.solution.u.copy()
    names = [one.name for one in problem.unknowns]
    u[names.index('effects.pressure_lag.fill')] += 0.5
    slow = retuned.solution.discrepancy
    stopped = setting.model(best.effects, replace(initial_solution(problem, u), discrepancy=slow))
    assert best.score + 100.0 < stopped.score < retuned.score - setting.criteria.margin
    found = Search(setting, retuned, retuned, [retuned, stopped])
    (again,) = accepted([stopped], retuned, found)
    assert again.score == pytest.approx(best.score, abs=0.1)
    assert found.evaluated == [retuned, stopped, again]
    # There the model of a fit that has converged is the same, but for the accuracy of the fits.
    (same,) = accepted([best], retuned, found)
    assert same.score == pytest.approx(best.score, abs=1e-2)
    np.testing.assert_allclose(same.solution.u, best.solution.u, atol=1e-3)


def test_parameters_without_influence_are_no_unknowns(tried, retuned, setting):
    """They are offered again: a breakaway friction below the level has no gradient."""
    place = setting.places['coulomb_friction']
    start = {'level': 20.0, 'breakaway': 8.0, 'stribeck_speed': 0.02}
    known = extended(retuned.solution, place, start, setting)
    model = setting.model(('coulomb_friction',), known)
    less = without_idle_parameters(model, setting)
    assert parameters_of(less.solution.problem.unknowns, place.name) == {'level'}
    assert less.effects == model.effects
    np.testing.assert_array_equal(less.solution.r, known.r)
    assert less.score <= model.score
    problem = less.solution.problem
    row = problem.row_at(less.solution.u)
    values = [row[place.indices(problem.layout, k)[0]] for k in range(len(place.parameters))]
    expected = [start['level'] if p.name == 'level' else p.default for p in place.parameters]
    assert values == pytest.approx(expected)
    offered = freed_starts(less, setting)
    assert any(one.get('breakaway', 0.0) > one.get('level', 20.0) for one in offered)
    # Each parameter of the lag has an influence.
    assert without_idle_parameters(tried[0], setting) is tried[0]


def test_friction_at_rest_moves_the_friction_while_sliding(retuned, setting):
    """Both begin around the friction that was fitted alone, with a fresh Jacobian."""
    place = setting.places['coulomb_friction']
    known = extended(retuned.solution, place, {'level': 20.0}, setting)
    model = setting.model(('coulomb_friction',), known)
    start = next(one for one in freed_starts(model, setting) if 'level' in one)
    wider = extended(known, place, start, setting)
    assert wider.value('effects.coulomb_friction.level') == pytest.approx(start['level'])
    again = initial_solution(wider.problem, wider.u, wider.discrepancy)
    np.testing.assert_allclose(wider.r, again.r, rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(wider.jacobian, again.jacobian, rtol=0.0, atol=1e-12)


def freed_starts(model, setting):
    """Return the starts of the additional parameters of a model's only effect."""
    known = model.solution
    row = known.problem.row_at(known.u)
    place = setting.places[model.effects[0]]
    return finer_starts(known.problem.unknowns, row, setting.joint, place)


def test_parameters_that_were_freed_and_are_not_needed_are_fixed(tried, retuned, setting):
    """The lag of this rig does not choke."""
    wider = max(with_more_parameters(tried[0], setting), key=lambda m: len(m.solution.u))
    plain = {'effects.pressure_lag.fill', 'effects.pressure_lag.vent'}
    less = with_fewer_parameters(wider, setting)
    assert effects_in(less[0]) == plain
    assert less[0].score < tried[0].score + 1.0
    best = confirm(Search(setting, retuned, wider, [retuned, *tried, wider]))
    assert effects_in(best) == plain
    assert with_fewer_parameters(best, setting) == []


@pytest.fixture(scope='module')
def full(retuned, setting):
    """Return the lag with parameters that the rig does not have, in addition to its two times."""
    start = {'fill': 0.05, 'vent': 0.05, 'choking': 0.1, 'supply': 8e5, 'dead_zone': 500.0}
    known = extended(retuned.solution, setting.places['pressure_lag'], start, setting)
    return setting.model(('pressure_lag',), converge(known, BUDGET.iterations))


def test_single_parameters_are_fixed_that_the_recording_hardly_shows(full, setting):
    """The rig has the two times of the lag, and none of its other parameters."""
    needless = ({'choking'}, {'supply'}, {'dead_zone'})
    there = parameters_of(full.solution.problem.unknowns, 'pressure_lag')
    less = moves.with_one_parameter_less(full, setting)
    left = [there - parameters_of(m.solution.problem.unknowns, 'pressure_lag') for m in less]
    assert left == [*needless]
    for model in less:
        assert not model.is_screened
        assert model.score < full.score


def test_the_expected_rise_of_a_score_is_that_of_a_fit(tried, setting):
    """A small offset and gain of the pressure change the run in proportion."""
    place = setting.places['pressure_offset']
    whole, without_gain = (
        converge(extended(tried[0].solution, place, start, setting), BUDGET.iterations)
        for start in ({'offset': 1e3, 'gain': 0.01}, {'offset': 1e3})
    )
    rise = moves.score_rises(whole, setting)['pressure_offset', 'gain']
    assert rise == pytest.approx(without_gain.score - whole.score, abs=0.5)


@pytest.fixture(scope='module')
def leaking(retuned, setting):
    """Return the lag explained by a leak, whose refill and venting are that lag."""
    start = {'rate': 0.01, 'refill': 0.1, 'vent': 0.1}
    known = extended(retuned.solution, setting.places['leak'], start, setting)
    return setting.model(('leak',), converge(known, BUDGET.iterations))


def test_a_fit_with_fewer_parameters_is_continued_unless_it_is_far_off(tried, setting):
    place = setting.places['pressure_lag']
    wider = extended(tried[0].solution, place, {'dead_zone': 1e3}, setting)
    now = setting.model(('pressure_lag',), converge(wider, 60))
    less = {frozenset(effects_in(m)): m for m in with_fewer_parameters(now, setting)}
    without_lag = less[frozenset({'effects.pressure_lag.dead_zone'})]
    assert without_lag.is_screened
    assert without_lag.score > now.score + moves.HOPELESS_MARGIN * CRITERIA.margin
    times = less[frozenset({'effects.pressure_lag.fill', 'effects.pressure_lag.vent'})]
    assert not times.is_screened
    assert times.score < now.score + CRITERIA.margin


def test_an_effect_is_weakened_to_each_set_of_its_strengths(retuned, setting):
    """Of those with time constants the one without further parameters; the zone is the other."""
    place = setting.places['pressure_lag']
    start = {'fill': 0.05, 'vent': 0.05, 'fastest': 1e6, 'dead_zone': 2e3}
    whole = setting.model(
        ('pressure_lag',), converge(extended(retuned.solution, place, start, setting), 5)
    )
    less = with_fewer_strengths(whole, 'pressure_lag', setting)
    assert [m.effects for m in less] == 2 * [('pressure_lag',)]
    sets = [parameters_of(m.solution.problem.unknowns, 'pressure_lag') for m in less]
    assert sets == [{'dead_zone'}, {'fill', 'vent'}]
    # The recording has a lag, and no zone.
    assert less[1].score < whole.score + setting.criteria.margin < less[0].score
    assert with_fewer_strengths(less[1], 'pressure_lag', setting) == []


def test_a_simpler_effect_begins_with_what_it_has_in_common(leaking, tried, retuned, setting):
    (lag,) = with_simpler_effect(leaking, 'leak', setting)
    assert lag.effects == ('pressure_lag',)
    assert effects_in(lag) == {'effects.pressure_lag.fill', 'effects.pressure_lag.vent'}
    assert lag.score < tried[0].score + 0.1
    known = extended(retuned.solution, setting.places['leak'], {'rate': 0.01}, setting)
    assert with_simpler_effect(setting.model(('leak',), known), 'leak', setting) == []
    assert with_simpler_effect(lag, 'pressure_lag', setting) == []


def test_a_broader_effect_is_simplified_with_finer_steps(leaking, tried, retuned, setting):
    assert abs(leaking.score - tried[0].score) < CRITERIA.margin
    best = confirm(Search(setting, retuned, leaking, [retuned, *tried, leaking]))
    assert best.effects == ('pressure_lag',)


def effects_in(model):
    names = {one.name for one in model.solution.problem.unknowns}
    return {name for name in names if name.startswith('effects.')}


def test_alternatives_are_within_the_margin(tried, retuned, setting):
    best = tried[0]
    found = Search(setting, retuned, best, [retuned, *tried])
    assert alternatives(found, 'pressure_lag') == ()
    wide = replace(setting, criteria=replace(CRITERIA, margin=1e9, worse=1e9))
    found = Search(wide, retuned, best, [retuned, *tried])
    assert set(alternatives(found, 'pressure_lag')) == {'dead_time', 'viscous_friction'}


def test_an_effect_that_was_chosen_before_a_better_one_is_exchanged(tried, retuned, setting):
    wrong = next(m for m in tried if m.effects == ('dead_time',))
    (both,) = with_each(wrong, ['viscous_friction'], setting)
    found = Search(setting, retuned, both, [retuned, *tried, both])
    better = exchange_effect(found)
    assert set(better.effects) == {'viscous_friction', 'pressure_lag'}
    assert better.score < both.score - CRITERIA.margin
    # Of a single one that is a round of its own.
    assert exchange_effect(Search(setting, retuned, wrong, [])) is None


def test_a_broader_effect_does_not_replace_one_that_is_as_good_once_fitted(
    tried, retuned, setting
):
    """A lag that was left where it began is worse than a leak, whose refill is this lag."""
    place = setting.places['viscous_friction']
    begun = extended(tried[0].solution, place, {'coefficient': 30.0}, setting)
    u = begun.u + 2.0 * np.array([k.name.endswith('fill') for k in begun.problem.unknowns])
    left = replace(begun, u=u, r=begun.problem.residuals(u), is_fresh=False)
    poor = setting.model(('pressure_lag', 'viscous_friction'), left)
    found = Search(setting, retuned, poor, [retuned, *tried, poor])
    better = exchange_effect(found)
    assert set(better.effects) == {'viscous_friction', 'pressure_lag'}
    assert better.score < poor.score - 1000.0


def test_what_the_right_effect_makes_unnecessary_is_removed_with_finer_steps(
    tried, retuned, setting
):
    (both,) = with_each(tried[0], ['viscous_friction'], setting)
    found = Search(setting, retuned, both, [retuned, *tried, both])
    assert confirm(found).effects == ('pressure_lag',)
    assert confirm(Search(setting, retuned, retuned, [retuned])) is retuned


@pytest.mark.parametrize(('noises', 'is_fine'), [(0.01, False), (10.0, True)])
def test_finer_steps_are_fitted_only_if_they_change_the_residuals(
    tried, retuned, setting, monkeypatch, noises, is_fine
):
    """The steps of a load that hits something are a model error; those of this load are none."""
    known = tried[0].solution
    residuals = type(known.problem).residuals

    def off(problem, u):
        is_coarse = problem.step == setting.step
        return residuals(problem, u) + (0.0 if is_coarse else noises * known.noise)

    monkeypatch.setattr(type(known.problem), 'residuals', off)
    best = confirm(Search(setting, retuned, tried[0], [retuned, *tried]))
    assert best.effects == ('pressure_lag',)
    finest = setting.step / BUDGET.finer if is_fine else setting.step
    assert best.solution.problem.step == finest
