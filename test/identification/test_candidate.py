# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A model with one effect more explains at least as much as the one without it."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import EFFECTS
from pam_ros.identification.candidate import (
    Fit,
    extended,
    fitted,
    guessed,
    look,
    refine,
    released,
)
from pam_ros.identification.data.noise import noise_of
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.retuning import problem_of
from pam_ros.identification.solve import solve
from support import bench_truth
from support.equations import equation, unknown
from truth import effect

pytestmark = pytest.mark.needs_numba
KNOWN = {e.name: e for e in EFFECTS}
MODEL = bench_truth.declared(off=[0.01, -0.01, 0.0, 0.01, 0.0, 0.01])


@pytest.fixture(scope='module')
def parent():
    """Return the re-tuned fit of a rig that has the friction of its guide as well."""
    recording = bench_truth.free(effect('viscous_friction'), seed=3, duration=12.0)
    segments = segments_of([recording], keep_back=True)
    noise = noise_of([(s.t, s.target) for s in segments])
    problem = problem_of(MODEL, segments, noise, 6e-3)
    return fitted((), solve(problem, np.zeros(len(problem.unknowns))))


@pytest.mark.parametrize('name', KNOWN)
def test_an_absent_effect_changes_nothing_and_a_fit_from_there_ends_no_higher(parent, name):
    """The optimiser's alarm: a nested model cannot end with a worse cost than its parent."""
    one = KNOWN[name]
    strengths = {p.name: 0.0 for p in one.parameters if p.strength}
    problem, added = extended(parent.solution.problem, MODEL, one, strengths)
    start = np.concatenate([parent.solution.u, added])
    np.testing.assert_allclose(problem.residuals(start), parent.solution.r, atol=1e-10)
    child = solve(problem, start, 3)
    assert child.cost <= parent.solution.cost + 1e-6


@pytest.mark.parametrize('name', KNOWN)
def test_a_full_fit_ends_no_higher_than_the_look_it_starts_from(parent, name):
    looks = look(parent, MODEL, KNOWN[name], 2, guessed(parent, KNOWN[name]))
    costs = [solution.cost for solution in looks]
    assert costs == sorted(costs)
    fit = refine(parent, KNOWN[name], looks[:1], None)
    assert fit.effects == (name,)
    assert fit.solution.cost <= costs[0] + 1e-9


def test_the_right_effect_explains_the_rest(parent):
    fits = {}
    for name in ('viscous_friction', 'coulomb_friction', 'pressure_dependent_damping', 'creep'):
        fits[name] = refine(parent, KNOWN[name], look(parent, MODEL, KNOWN[name], 2), None)
    fit = min(fits.values(), key=lambda fit: fit.score)
    assert fit.effects == ('viscous_friction',)
    found = fit.solution.value('effects.viscous_friction.coefficient')
    assert found == pytest.approx(60.0, rel=0.05)
    assert fit.held_error < 1.2 * 20e-6
    assert parent.held_error > 3.0 * fit.held_error
    assert fit.score < parent.score


def test_an_effect_has_the_values_of_its_start_and_else_its_defaults(parent):
    friction = KNOWN['coulomb_friction']
    start = {'level': 5.0, 'breakaway': 8.0, 'stribeck_speed': 0.02}
    problem, added = extended(parent.solution.problem, MODEL, friction, start)
    row = problem.row_at(np.concatenate([parent.solution.u, added]))
    for k, p in enumerate(friction.parameters):
        assert row[MODEL.layout.index(friction, k)] == pytest.approx(start.get(p.name, p.default))
    names = [unknown.name.rsplit('.', 1)[-1] for unknown in problem.unknowns[-3:]]
    assert set(names) == set(start)
    # The parent's own problem stays as it was.
    assert parent.solution.problem.row[MODEL.layout.index(friction)] == 0.0


def test_nothing_is_released_where_everything_moves_already(parent):
    viscous = KNOWN['viscous_friction']
    fit = refine(parent, viscous, look(parent, MODEL, viscous, 2), None)
    with ThreadPoolExecutor() as pool:
        assert released(fit, MODEL, viscous, pool) is fit


def test_finer_parameters_must_earn_their_cost(parent):
    friction = KNOWN['coulomb_friction']
    problem, added = extended(parent.solution.problem, MODEL, friction, {'level': 3.0})
    plain = fitted(
        ('coulomb_friction',), solve(problem, np.concatenate([parent.solution.u, added]))
    )
    with ThreadPoolExecutor() as pool:
        wide = released(plain, MODEL, friction, pool)
    assert wide is plain or wide.score < plain.score
    assert wide.solution.cost <= plain.solution.cost


def test_a_score_is_schwarzs():
    unknowns = [
        unknown('a1', 0.0, 1.0, prior=1.0),  # expected beforehand: costs by its prior
        unknown('x', 0.0, 1.0),
        unknown('y', 0.0, 1.0),
        unknown('y0[0]', 0.0, 1.0, run=0),  # a start state, the same in all models
    ]
    problem = equation(lambda u: np.array([1.0, 2.0, 2.0]) + 0.0 * u[0], unknowns, 50.0)
    u = np.array([2.0, 0.0, 0.0, 0.0])
    solution = solve(problem, u, 0, jacobian=np.zeros((3, 4)))
    fit = Fit((), solution, 0.0, 0.0)
    assert fit.score == pytest.approx(50.0 * np.log(3.0) + 4.0 + 2.0 * np.log(50.0))
    assert replace(fit, effects=('creep',)).score == fit.score


def test_a_start_is_read_from_what_was_measured_and_may_be_seen(parent):
    """What a model without the effect does says nothing of where a stop is."""
    told = {}

    def guess(t, p, kappa, residual):
        told.update(kappa=kappa, residual=residual)
        return ({'upper': 0.1, 'stiffness': 1e4},)

    found = guessed(parent, replace(KNOWN['end_stop'], guess=guess))
    assert found == ({'upper': 0.1, 'stiffness': 1e4},)
    (s,) = parent.solution.problem.segments
    assert np.array_equal(np.isnan(told['kappa']), ~s.fit)
    np.testing.assert_allclose(told['kappa'][s.fit], s.target[s.fit] / MODEL.muscle.l0)
    assert np.all(told['residual'][~s.fit] == 0.0)
    assert np.any(told['residual'][s.fit] != 0.0)
