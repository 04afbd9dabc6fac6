# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that are found two at a time."""

from dataclasses import replace

import pytest

from pam_ros.identification.candidate import fitted
from pam_ros.identification.pairs import FAR, paired
from pam_ros.identification.solve import solve
from support.rounds import KNOWN, MODEL, setting_of
from truth import effect

pytestmark = pytest.mark.needs_numba
EFFECTS = tuple(KNOWN[n] for n in ('coulomb_friction', 'creep', 'viscous_friction', 'payload'))


@pytest.fixture(scope='module')
def setting():
    """Return the setting of a rig that sticks and creeps."""
    with setting_of(MODEL, effect('coulomb_friction'), effect('creep')) as found:
        yield found


@pytest.fixture(scope='module')
def retuned(setting):
    known = setting.declared.solution
    return fitted((), solve(known.problem, known.u))


@pytest.mark.slow
def test_two_are_found_together(setting, retuned):
    assert retuned.fit_error > FAR * setting.noise.sigma
    pair, rounds = paired(retuned, retuned, EFFECTS, setting)
    assert set(pair.effects) == {'coulomb_friction', 'creep'}
    assert pair.held_error < 0.3 * retuned.held_error
    tried = [one for (one,) in rounds]
    assert {one.effect.name for one in tried} == set(pair.effects)
    for one in tried:
        assert one.chosen
        assert {*one.parents, one.effect.name} == set(pair.effects)
        assert one.fit.effects[-1] == one.effect.name
        assert one.evidence.gain > 0.1
        assert one.evidence.interval_clear


def test_of_no_two_that_are_much_better_nothing_is_made(setting, retuned):
    others = [KNOWN[name] for name in ('length_offset', 'payload')]
    assert paired(retuned, retuned, others, setting) == (retuned, ())


def test_a_search_that_has_arrived_is_left_alone(setting, retuned):
    arrived = replace(retuned, fit_error=0.99 * FAR * setting.noise.sigma)
    assert paired(arrived, retuned, EFFECTS, setting) == (arrived, ())
