# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is not needed is left out, and what is needed stays."""

import numpy as np
import pytest

from pam_ros.identification import elimination
from pam_ros.identification.elimination import (
    became,
    dropped,
    plain,
    promises_little,
    without_needless,
)
from support.rounds import KNOWN, MODEL, retuned, with_effect_starts, with_effects
from truth import effect

pytestmark = pytest.mark.needs_numba


@pytest.fixture(scope='module')
def right(setting):
    """Return the fit of friction and lag."""
    return with_effects(setting, 'viscous_friction', 'pressure_lag')


def unknowns_of(fit, name):
    every = (u.name for u in fit.solution.problem.unknowns)
    prefix = f'effects.{name}.'
    return {one.removeprefix(prefix) for one in every if one.startswith(prefix)}


def test_finer_parameters_that_earn_nothing_are_left_out(setting):
    fine = {'fill': 0.05, 'vent': 0.05, 'fastest': 5e5}
    friction = KNOWN['viscous_friction'].fit_starts[0]
    wide = with_effect_starts(setting, {'viscous_friction': friction, 'pressure_lag': fine})
    assert unknowns_of(wide, 'pressure_lag') == set(fine)
    fit = plain(wide, MODEL, setting.pool)
    assert unknowns_of(fit, 'pressure_lag') == {'fill', 'vent'}
    assert fit.held_error < 1.02 * wide.held_error


def test_each_set_of_finer_parameters_is_tried_once(setting, monkeypatch):
    start = KNOWN['creep'].fit_starts[2]
    assert [set(one) for one in KNOWN['creep'].fit_starts].count({'stiffness', 'time'}) > 1
    wide = with_effect_starts(setting, {'creep': start})
    solved = []

    def solve(problem, u, **options):
        solved.append(frozenset(one.name for one in problem.unknowns))
        return elimination_solve(problem, u, **options)

    elimination_solve = elimination.solve
    monkeypatch.setattr(elimination, 'solve', solve)
    monkeypatch.setattr(elimination, 'EARNED', -1e9)  # none is good enough
    plain(wide, MODEL, setting.pool)
    assert len(solved) == len(set(solved)) > 0


def test_an_effect_that_brings_nothing_is_left_out_and_others_stay(setting, right):
    starts = {
        'viscous_friction': KNOWN['viscous_friction'].fit_starts[0],
        'pressure_lag': KNOWN['pressure_lag'].fit_starts[0],
        'payload': {'mass': 0.2},
    }
    three = with_effect_starts(setting, starts)
    assert promises_little(three, 'payload', 20.0, MODEL)
    fit = without_needless(
        three, three.effects, retuned(setting), MODEL, setting.noise, setting.pool
    )
    assert fit.effects == right.effects
    assert fit.held_error < 1.02 * right.held_error


def test_what_is_needed_promises_much_and_leaves_much(setting, right):
    for name in right.effects:
        assert not promises_little(right, name, 100.0, MODEL)
        without = dropped(right, name, MODEL, setting.pool)
        assert without.effects == tuple(e for e in right.effects if e != name)
        assert without.solution.cost > right.solution.cost + 100.0
        assert without.held_error > 1.2 * right.held_error
    fit = without_needless(
        right, right.effects, retuned(setting), MODEL, setting.noise, setting.pool
    )
    assert fit is right


def test_what_is_contained_begins_where_the_other_has_it(setting):
    leak = {'rate': 0.02, 'refill': 0.03, 'vent': 0.05}
    friction = KNOWN['viscous_friction'].fit_starts[0]
    both = with_effect_starts(setting, {'leak': leak, 'viscous_friction': friction})
    fit = became(both, 'leak', KNOWN['pressure_lag'], MODEL, setting.pool)
    assert fit.effects == ('viscous_friction', 'pressure_lag')
    assert fit.held_error < 1.02 * both.held_error
    row = fit.solution.problem.row_at(fit.solution.u)
    assert row[MODEL.layout.index(KNOWN['leak'])] == 0.0
    at_lag = MODEL.layout.index(KNOWN['pressure_lag'])
    there = effect('pressure_lag').values
    np.testing.assert_allclose(
        row[at_lag : at_lag + 2], [there['fill_s'], there['vent_s']], rtol=0.05
    )
