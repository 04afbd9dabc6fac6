# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The candidates of a search on a rig with a lag: numbers by hand, decisions with reasons."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from pam_ros.identification.search.criteria import CRITERIA
from pam_ros.identification.search.moves import with_each
from pam_ros.identification.search.search import Search
from pam_ros.identification.search.table import candidates, is_instead_of_constants, reason_for

pytestmark = [pytest.mark.slow, pytest.mark.needs_numba]
NAMES = ['pressure_lag', 'dead_time', 'viscous_friction', 'end_stop']


@pytest.fixture(scope='module')
def search(retuned, setting):
    """Return a search that has found the lag, and then tried one more."""
    tried = with_each(retuned, NAMES, setting)
    more = with_each(tried[0], ['viscous_friction'], setting)
    return Search(setting, retuned, tried[0], [retuned, *tried, *more])


@pytest.fixture(scope='module')
def table(search):
    return candidates(search)


def test_there_is_a_row_for_each_effect_on_top_of_each_model(table):
    assert {(row.parents, row.effect) for row in table} == {
        *(((), name) for name in NAMES),
        (('pressure_lag',), 'viscous_friction'),
    }
    assert len(table) == 5
    assert [len(row.parents) for row in table] == [0, 0, 0, 0, 1]


def test_other_constants_could_not_replace_a_lag(search):
    assert not is_instead_of_constants(search, 'pressure_lag')


def test_numbers_are_those_of_the_models(table, search, retuned):
    best, row = search.best, next(r for r in table if r.effect == 'pressure_lag')
    assert (row.fit_error, row.choose_error) == (best.errors.fit, best.errors.choose)
    assert row.score_fall == retuned.score - best.score
    assert row.gain == pytest.approx(1.0 - best.errors.choose / retuned.errors.choose)
    fill = row.parameters['fill']
    assert 0.0 < fill.low < fill.value < fill.high
    assert fill.value == pytest.approx(best.solution.value('effects.pressure_lag.fill'))
    unknowns = {unknown.name for unknown in best.solution.problem.unknowns}
    assert {f'effects.pressure_lag.{name}' for name in row.parameters} == {
        name for name in unknowns if name.startswith('effects.')
    }
    assert {'fill', 'vent'} <= set(row.parameters)


def test_intervals_are_clear_if_those_of_all_strengths_exclude_0(table):
    strengths = {
        'pressure_lag': {'fill', 'vent', 'dead_zone'},
        'dead_time': {'delay'},
        'viscous_friction': {'coefficient'},
        'end_stop': {'stiffness', 'lower_stiffness'},
    }
    for row in table:
        known = [row.parameters[name] for name in strengths[row.effect] & set(row.parameters)]
        assert known
        assert row.interval_clear == all(one.low > 0.0 or one.high < 0.0 for one in known)
    assert {row.interval_clear for row in table} == {True, False}


def test_p_is_that_of_the_likelihood_ratio_for_all_that_were_tried(table, search, retuned):
    row = next(r for r in table if r.effect == 'viscous_friction' and not r.parents)
    model = next(m for m in search.evaluated if m.effects == ('viscous_friction',))
    fall = retuned.solution.cost - model.solution.cost
    more = len(model.solution.u) - len(retuned.solution.u)
    assert row.p == pytest.approx(min(1.0, 4.0 * chi2.sf(fall, more)))
    last = table[-1]
    assert 0.0 < last.p <= 1.0
    assert np.isfinite(last.score_fall)


def test_decisions_have_reasons(table):
    reason = {(row.parents, row.effect): (row.decision, row.reason) for row in table}
    decision, why = reason[(), 'pressure_lag']
    assert decision == 'chosen'
    assert 'lowers the score by' in why
    assert 'error of samples that were not fitted by' in why
    for name in ('dead_time', 'viscous_friction', 'end_stop'):
        assert reason[(), name][0] == 'rejected'
    assert 'pressure_lag lowers the score by' in reason[(), 'dead_time'][1]
    decision, why = reason[('pressure_lag',), 'viscous_friction']
    assert decision == 'rejected'
    assert f'a decrease of {CRITERIA.margin:g} is required' in why


def test_the_reason_of_an_effect_is_what_the_best_model_without_it_lacks(search, retuned):
    fall = retuned.score - search.best.score
    assert reason_for(search, 'pressure_lag').startswith(f'lowers the score by {fall:.0f}, and ')


def test_what_is_within_the_margin_is_ambiguous(search):
    wide = replace(CRITERIA, margin=1e9, worse=1e9)
    found = replace(search, setting=replace(search.setting, criteria=wide))
    decisions = {row.effect: row.decision for row in candidates(found) if not row.parents}
    assert decisions == {
        'pressure_lag': 'chosen',
        **dict.fromkeys(('dead_time', 'viscous_friction', 'end_stop'), 'ambiguous'),
    }


def test_a_move_that_makes_the_free_run_worse_is_marked(search):
    strict = replace(CRITERIA, worse=0.01)
    found = replace(search, setting=replace(search.setting, criteria=strict))
    row = next(r for r in candidates(found) if r.effect == 'dead_time')
    assert row.decision == 'rejected'
    assert row.reason.startswith('the error of the free run is ')
    assert 'over samples that were not fitted, and ' in row.reason
    model = next(m for m in search.evaluated if m.effects == ('dead_time',))
    for now, before in (
        (model.errors.free_run, search.retuned.errors.free_run),
        (model.errors.fit, search.retuned.errors.fit),
    ):
        change = 100.0 * (now / before - 1.0)
        assert f'{abs(change):.0f} % {"larger" if change > 0.0 else "smaller"}' in row.reason
