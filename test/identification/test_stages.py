# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Intervals of fits hold the truth; stages have the errors of what they were judged on."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.candidate import extended, fitted
from pam_ros.identification.data.noise import Noise, noise_of
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.retuning import problem_of
from pam_ros.identification.solve import Solution, solve
from pam_ros.identification.stages import estimates, stage
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import one_muscle
from pam_ros.rig.loads import Mass
from support import bench_truth
from truth import effect

BAR = one_muscle(Muscle(), Mass(mass=20.0))


def held_segments(kappas=(0.02, 0.1, 0.18)):
    """Return held runs over the working range, of a muscle whose forces are noisy."""
    rng = np.random.default_rng(0)
    runs = []
    for kappa in kappas:
        t = np.arange(300) / 50.0
        p = rng.uniform(1.5e5, 5e5, t.size)
        force = BAR.muscle.force(p, kappa) + 2.0 * rng.standard_normal(t.size)
        y = np.full(t.size, kappa * 0.4)
        runs.append(Recording('h', t, None, None, y, None, force, p, 'held'))
    return segments_of(runs, keep_back=True)


def fit_of(model, u=None):
    """Return a fit that stands at u."""
    problem = problem_of(model, held_segments(), Noise(2.0, 0.0), 1e-3)
    u = np.zeros(len(problem.unknowns)) if u is None else u
    r = problem.residuals(u)
    return fitted((), Solution(problem, u, r, problem.jacobian(u, r), 0))


def test_an_interval_by_hand():
    # With priors on all constants and a linear law, the posterior is a Gaussian known exactly.
    fit = fit_of(BAR)
    problem, solution = fit.solution.problem, fit.solution
    j, r = solution.jacobian[:, :6], solution.r
    normal = r.size / (r @ r) * j.T @ j + np.eye(6)
    error = np.sqrt(np.linalg.inv(normal)[4, 4]) * problem.unknowns[4].scale * 1e5
    found = estimates(fit, BAR)['a5']
    # White residuals are worth nearly all of their samples.
    assert (found.high - found.low) / 2.0 == pytest.approx(1.96 * error, rel=0.15)


def test_a_value_at_its_bound_is_marked():
    problem = fit_of(BAR).solution.problem
    viscous = next(e for e in BAR.library if e.name == 'viscous_friction')
    wider, _ = extended(problem, BAR, viscous, {'coefficient': 30.0})
    u = np.zeros(len(wider.unknowns))  # a coefficient of 0, the least that is allowed
    r = wider.residuals(u)
    jacobian = np.column_stack([np.ones((r.size, u.size - 1)), np.sin(np.arange(r.size))])
    found = estimates(fitted(('viscous_friction',), Solution(wider, u, r, jacobian, 0)), BAR)
    one = found['effects.viscous_friction.coefficient']
    assert one.at_bound
    assert (one.value, one.low) == (0.0, 0.0)
    assert one.unit == 'N s/m'
    assert not found['a5'].at_bound


def test_stages_are_judged_on_the_test_when_there_is_one():
    fit = fit_of(BAR)
    tests = [replace(s, target=s.target + 5.0) for s in held_segments((0.05,))]
    declared = stage('declared', BAR, fit, ())
    assert declared.held_error == fit.held_error
    assert all(one.low == one.value == one.high for one in declared.parameters.values())
    assert (len(declared.simulated), declared.tested) == (3, ())
    retuned = stage('retuned', BAR, fit, tests)
    (tested,) = retuned.tested
    error = np.sqrt(np.mean((tested - tests[0].target) ** 2))
    assert retuned.held_error == pytest.approx(error)
    assert retuned.held_error == pytest.approx(np.hypot(5.0, 2.0), rel=0.1)
    assert retuned.fit_error == fit.fit_error
    assert any(one.low < one.high for one in retuned.parameters.values())


@pytest.mark.needs_numba
@pytest.mark.parametrize('rho', [0.0, 0.8])
def test_intervals_hold_the_truth(rho):
    """The truth plant's constants, and a friction, in some 95 % of the intervals."""
    friction = 60.0
    viscous = next(e for e in BAR.library if e.name == 'viscous_friction')
    inside = []
    for seed in range(6):
        true = bench_truth.declared()
        off = 0.02 * np.random.default_rng(seed).standard_normal(6)
        model = bench_truth.declared(off=off, zeta=0.18)
        recording = bench_truth.free(
            effect('viscous_friction', viscous_ns_m=friction),
            seed=seed, rho=rho, duration=12.0, rate=200.0,
        )  # fmt: skip
        segments = segments_of([recording], keep_back=True)
        noise = noise_of([(s.t, s.target) for s in segments])
        problem = problem_of(model, segments, noise, 5e-3)
        wider, added = extended(problem, model, viscous, {'coefficient': 30.0})
        fit = fitted(
            ('viscous_friction',), solve(wider, np.append(np.zeros(len(problem.unknowns)), added))
        )
        found = estimates(fit, model)
        truth = {f'a{k + 1}': a for k, a in enumerate(true.muscle.si)}
        truth |= {'zeta': 0.15, 'effects.viscous_friction.coefficient': friction}
        inside += [found[name].low <= value <= found[name].high for name, value in truth.items()]
        assert found['effects.viscous_friction.coefficient'].value == pytest.approx(60.0, rel=0.2)
    assert np.mean(inside) >= 0.8
