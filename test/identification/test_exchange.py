# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that were chosen too early: the exchange of one for another that explains more."""

from dataclasses import replace

import pytest

from pam_ros.identification.exchange import exchanged
from pam_ros.identification.round import try_effects
from support.rounds import KNOWN, MODEL, retuned, setting_of, with_effect_starts, with_effects
from truth import effect

pytestmark = pytest.mark.needs_numba


@pytest.mark.slow
def test_an_effect_that_was_taken_for_another_is_exchanged(setting):
    taken = with_effects(setting, 'dead_time', 'viscous_friction')
    assert taken.held_error > 1.5 * setting.noise.sigma
    fit, rounds = exchanged(taken, (), setting)
    assert fit.effects == ('viscous_friction', 'pressure_lag')
    assert fit.held_error < 1.2 * setting.noise.sigma
    ((*tried,),) = rounds
    assert [one.effect.name for one in tried if one.chosen] == ['pressure_lag']
    assert all(one.parents == ('viscous_friction',) for one in tried)


@pytest.mark.slow
def test_one_that_made_up_for_what_was_missing_is_exchanged_for_one_that_came_near():
    """A quick creep has parameters enough to pass for a delay beside damping."""
    damping = effect(
        'pressure_dependent_damping', damping_up_ns_m_bar=12.0, damping_down_ns_m_bar=18.0
    )
    with setting_of(MODEL, damping, effect('dead_time', dead_time_s=6e-3)) as setting:
        _, tried = try_effects(retuned(setting), [KNOWN['creep'], KNOWN['dead_time']], setting)
        by = {t.effect.name: t for t in tried}
        first = tuple(replace(t, chosen=t is by['creep']) for t in tried)
        start = dict(KNOWN['creep'].fit_starts[0])
        both = with_effect_starts(
            setting,
            {'creep': start, 'pressure_dependent_damping': {'inflating': 1e-4, 'deflating': 1e-4}},
        )
        fit, rounds = exchanged(both, [first], setting)
        assert fit.effects == ('pressure_dependent_damping', 'dead_time')
        assert fit.held_error < 1.1 * setting.noise.sigma
        assert rounds[0] == first
        alone = exchanged(both, [], setting)[0]
        assert 'dead_time' not in alone.effects


@pytest.mark.slow
def test_one_that_contains_another_gives_way_where_that_explains_as_much(setting):
    leak = {'rate': 0.02, 'refill': 0.03, 'vent': 0.05}
    friction = KNOWN['viscous_friction'].fit_starts[0]
    both = with_effect_starts(setting, {'leak': leak, 'viscous_friction': friction})
    fit, rounds = exchanged(both, (), setting)
    assert fit.effects == ('viscous_friction', 'pressure_lag')
    assert len(rounds) == 1


def test_what_is_right_stays(setting):
    right = with_effects(setting, 'pressure_lag', 'viscous_friction')
    fit, rounds = exchanged(right, (), setting)
    assert fit is right
    assert rounds == []
