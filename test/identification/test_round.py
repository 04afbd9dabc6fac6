# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A round of candidates, and the exchange of one for another that explains more."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from pam_ros.effects import EFFECTS
from pam_ros.identification.candidate import extended, fitted
from pam_ros.identification.coarse import coarse_step, thinned
from pam_ros.identification.exchange import exchanged
from pam_ros.identification.noise import noise_of
from pam_ros.identification.retuning import only_starts, problem_of
from pam_ros.identification.round import Setting, try_effects
from pam_ros.identification.segment import segments_of
from pam_ros.identification.solve import solve
from pam_ros.identification.weak import motion_of
from support import bench_truth
from truth import effect

pytestmark = pytest.mark.needs_numba
KNOWN = {e.name: e for e in EFFECTS}
MODEL = bench_truth.declared(off=[0.01, -0.01, 0.0, 0.01, 0.0, 0.01])


@pytest.fixture(scope='module')
def setting():
    """Return the setting of a rig with friction and a lag, and the problem of re-tuning it."""
    effects = (effect('viscous_friction'), effect('pressure_lag'))
    full = segments_of([bench_truth.free(*effects, seed=3, rate=200.0)], keep_back=True)
    noise = noise_of([(s.t, s.target) for s in full])
    thin = [thinned(s, coarse_step(MODEL)) for s in full]
    problem = problem_of(MODEL, thin, noise, coarse_step(MODEL), 1)
    motions = [motion_of(f, s, noise.sigma) for f, s in zip(full, thin, strict=True)]
    with ThreadPoolExecutor() as pool:
        declared = fitted((), only_starts(problem, np.zeros(len(problem.unknowns)), pool))
        yield Setting(MODEL, declared, noise, motions, pool)


def with_effects(setting, *names):
    """Return the fit of these effects, each from the first of its starts."""
    fit = setting.declared
    for name in names:
        known = fit.solution
        problem, added = extended(known.problem, MODEL, KNOWN[name], KNOWN[name].fit_starts[0])
        fit = fitted((*fit.effects, name), solve(problem, np.concatenate([known.u, added])))
    return fit


def test_no_candidate_has_the_credit_for_what_its_parent_missed(setting):
    right = with_effects(setting, 'viscous_friction', 'pressure_lag')
    assert right.held_error < 1.2 * setting.noise.sigma
    u = right.solution.u.copy()
    u[:3] += 1.0
    astray = fitted(right.effects, solve(right.solution.problem, u, 0))
    assert astray.held_error > 5.0 * right.held_error
    parent, tried = try_effects(astray, [KNOWN['creep'], KNOWN['end_stop']], setting)
    assert parent.effects == right.effects
    assert parent.held_error < 1.1 * right.held_error
    for one in tried:
        assert one.parents == right.effects
        assert one.evidence.gain < 0.05


def test_an_effect_that_was_taken_for_another_is_exchanged(setting):
    taken = with_effects(setting, 'dead_time', 'viscous_friction')
    assert taken.held_error > 1.5 * setting.noise.sigma
    fit, rounds = exchanged(taken, setting)
    assert fit.effects == ('viscous_friction', 'pressure_lag')
    assert fit.held_error < 1.2 * setting.noise.sigma
    ((*tried,),) = rounds
    assert [one.effect.name for one in tried if one.chosen] == ['pressure_lag']
    assert all(one.parents == ('viscous_friction',) for one in tried)


def test_one_that_contains_another_gives_way_where_that_explains_as_much(setting):
    taken = with_effects(setting, 'viscous_friction')
    leak = KNOWN['leak']
    known = taken.solution
    start = {'rate': 0.02, 'refill': 0.03, 'vent': 0.05}
    problem, added = extended(known.problem, MODEL, leak, start)
    both = fitted(('leak', 'viscous_friction'), solve(problem, np.r_[known.u, added]))
    fit, rounds = exchanged(both, setting)
    assert fit.effects == ('viscous_friction', 'pressure_lag')
    assert len(rounds) == 1


def test_what_is_right_stays(setting):
    right = with_effects(setting, 'pressure_lag', 'viscous_friction')
    fit, rounds = exchanged(right, setting)
    assert fit is right
    assert rounds == ()
