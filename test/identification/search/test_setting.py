# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of models over the parts of a recording, against simulations by hand."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import Creep
from pam_ros.identification.data.thinning import LONGEST_PERIOD, PERIODS, coarse_period
from pam_ros.identification.fit.extend import with_effect
from pam_ros.identification.fit.solve import (
    initial_solution,
    least_squares,
    with_nominal_constants,
)
from pam_ros.identification.fit.unknowns import MemoryStart
from pam_ros.identification.search.criteria import BUDGET, CRITERIA
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.loads import Mass
from pam_ros.rig.run import simulate, simulate_held
from pam_ros.rig.standard_joints import single_muscle_joint
from support import bench_truth
from support.searches import NOISE, at_nominal, on_rail, recorded_on_rail, setting_of


def rms(e):
    return float(np.sqrt(np.mean(e**2)))


def test_errors_are_those_of_one_free_run_through_all_parts(setting, retuned):
    solution = retuned.solution
    (part,) = setting.thin
    s = part.segment
    unknowns = solution.problem.unknowns
    u = {k.name: k.value(x) for k, x in zip(unknowns, retuned.nearest.u, strict=True)}
    muscle = replace(
        setting.joint.muscle, **{f'a{k}': u[f'a{k}'] for k in range(1, 7)}, zeta=u['zeta']
    )
    model = single_muscle_joint(muscle, setting.joint.load)
    run = simulate(model, s.t, s.drive, s.drive_t, position=u['y0[0]'], velocity=u['v0[0]'])
    e = run.position - s.target
    assert retuned.errors.fit == pytest.approx(rms(e[part.fit]), rel=0.01)
    assert retuned.errors.choose == pytest.approx(rms(e[part.choose]), rel=0.01)
    assert retuned.errors.free_run == retuned.errors.choose


def test_errors_are_those_of_the_nearest_free_run_whatever_the_score_prefers(setting, retuned):
    """A slow discrepancy lets the free run of a model without the lag drift."""
    solution = retuned.solution
    assert solution.discrepancy.size > 1.0
    far, near = setting.errors(solution).fit, setting.errors(least_squares(solution)).fit
    assert far > 1.2 * near
    assert retuned.errors.fit == pytest.approx(near, rel=0.01)
    assert retuned.score == solution.score
    # The few cheap iterations of a look come most of the way.
    evaluated = setting.model((), solution, is_screened=True).errors.fit
    assert 0.99 * near < evaluated < near + 0.5 * (far - near)


def far_off(setting, retuned, by):
    """Return the re-tuned model's solution with its constants *by* deviations off, and which."""
    problem = setting.problem
    constants = np.array([one.is_parameter for one in problem.unknowns])
    signs = np.where(np.arange(constants.size) % 2, -1.0, 1.0)
    u = np.where(constants, by * signs * problem.prior, retuned.nearest.u)
    return initial_solution(problem, u), constants


def test_constants_go_back_to_their_nominal_values_where_a_fit_has_moved_them(setting, retuned):
    known, constants = far_off(setting, retuned, 1.1)
    (back,) = with_nominal_constants(known)
    np.testing.assert_array_equal(back.u, np.where(constants, 0.0, known.u))
    np.testing.assert_array_equal(back.r, known.problem.residuals(back.u))
    assert not back.is_fresh
    assert with_nominal_constants(far_off(setting, retuned, 0.9)[0]) == []


def test_the_nearest_free_run_is_looked_for_from_nominal_constants_too(setting, retuned):
    """Here without any iterations: of two places the better one counts."""
    short = replace(setting, budget=replace(BUDGET, nearer=0))
    known, _ = far_off(setting, retuned, 12.0)
    (nominal,) = with_nominal_constants(known)
    errors = short.model((), known).errors
    assert errors == short.errors(nominal)
    assert errors.fit < 0.9 * short.errors(known).fit
    best = retuned.errors.fit
    assert short.model((), least_squares(known, 60)).errors.fit == pytest.approx(best, rel=0.01)


def test_at_a_prescribed_length_what_chooses_begins_at_rest(pool):
    """A fitted start of a memory is worth nothing in another recording."""
    joint = bench_truth.nominal()
    setting = setting_of([bench_truth.held(rate=50.0)], pool, joint)
    start = {'pressure': 0.1, 'time': 20.0}
    problem, added = with_effect(setting.problem, joint, setting.places['creep'], start)
    u = np.concatenate([np.zeros(len(setting.problem.unknowns)), added])
    memories = [isinstance(one.of, MemoryStart) for one in problem.unknowns]
    assert any(memories)
    unsettled = setting.errors(initial_solution(problem, np.where(memories, 5.0, u)))
    (part,) = setting.thin
    s = part.segment
    creeping = single_muscle_joint(joint.muscle, joint.load, effects=[Creep(**start)])
    run = simulate_held(creeping, s.t, s.pressure, s.position)
    e = run.force - s.target
    assert unsettled.choose == pytest.approx(rms(e[part.choose]), rel=0.02)
    assert unsettled.free_run == unsettled.choose
    settled = setting.errors(initial_solution(problem, u))
    assert settled.fit == pytest.approx(rms(e[part.fit]), rel=0.02)
    assert settled.choose == unsettled.choose
    assert abs(unsettled.fit - settled.fit) > 0.1


def test_the_noise_is_found_without_what_judges(setting):
    assert setting.noise == pytest.approx(NOISE, rel=0.2)
    (part,) = setting.parts
    target = part.segment.target.copy()
    target[part.judge] = np.random.default_rng(0).normal(size=part.judge.sum())
    spoiled = replace(part, segment=replace(part.segment, target=target))
    assert replace(setting, parts=[spoiled]).noise == setting.noise


def test_what_is_above_the_noise(setting):
    assert setting.above(setting.noise) == 0.0
    assert setting.above(np.sqrt(2.0) * setting.noise) == pytest.approx(setting.noise)


def test_strain_is_the_prior_chi_square_of_constants_alone(setting):
    problem = setting.problem
    u = np.arange(1.0, 1.0 + len(problem.unknowns))
    known = [one.name in ('a1', 'a2', 'a3', 'a4', 'a5', 'a6', 'zeta') for one in problem.unknowns]
    model = setting.model((), initial_solution(problem, u))
    assert model.strain == pytest.approx(float(np.sum(u[known] ** 2)))


DECLARED = on_rail(0.0102)


def test_of_more_samples_than_a_search_needs_fewer_are_used_as_the_rig_allows(pool):
    slow = single_muscle_joint(Muscle(), Mass(mass=80.0, mount='horizontal'))
    t = np.arange(2000) * 5e-3
    command = 2e5 + 1e5 * np.sin(3.0 * t)
    y = simulate(slow, t, command, position=0.03).position
    plain = setting_of([Recording('slow', t, t, command, y)], pool, slow)
    size = plain.thin[0].segment.t.size
    assert plain.period == PERIODS[1]
    for share, times in ((1.01, 1.0), (0.51, 2.0), (0.34, 3.0)):
        setting = replace(plain, budget=replace(BUDGET, samples=int(share * size)))
        assert setting.period == pytest.approx(times * PERIODS[1])
        assert setting.thin[0].segment.t.size == pytest.approx(size / times, rel=0.02)
        assert setting.step > setting.period
    # Not longer than the rig's own frequency allows, here 3.04 times as long.
    fewest = replace(plain, budget=replace(BUDGET, samples=int(0.1 * size)))
    assert fewest.period == coarse_period(slow, LONGEST_PERIOD) < 4.0 * PERIODS[1]


def test_the_rests_of_too_many_samples_are_shortened(pool):
    slow = single_muscle_joint(Muscle(), Mass(mass=80.0, mount='horizontal'))
    t = np.arange(6000) * 1e-2
    command = np.where(t < 30.0, 2e5, 3e5)
    run = simulate(slow, t, command, position=float(equilibrium(slow, 2e5)))
    y = run.position + NOISE * np.random.default_rng(0).standard_normal(t.size)
    many = replace(BUDGET, samples=10_000)
    plain = setting_of([Recording('rests', t, t, command, y)], pool, slow, 0.9, 0.95, many)
    short = replace(plain, budget=replace(BUDGET, samples=1700))
    size = [setting.thin[0].segment.t.size for setting in (plain, short)]
    assert plain.period == short.period
    assert size[1] < 0.5 * size[0]


def test_a_load_without_a_spring_is_fitted_in_short_runs_and_carried_on_in_one(pool):
    """Configured 2 % too strong, it runs away."""
    setting = setting_of([recorded_on_rail(on_rail())], pool, DECLARED)
    problem = setting.problem
    assert len(problem.segments) == round(CRITERIA.fit * 16.0 / BUDGET.window)
    assert max(s.t[-1] for s in problem.segments) < CRITERIA.fit * 16.0
    errors = setting.errors(at_nominal(problem))
    assert errors.free_run > 2.0 * errors.choose > 2.0 * NOISE
    # The run that is carried on is the configured model's, from the measured start.
    s = setting.thin[0].segment
    run = simulate(
        DECLARED, s.t, s.drive, s.drive_t, position=s.y0, velocity=s.v0, step=setting.step
    ).position
    keep = setting.thin[0].choose
    assert errors.free_run == pytest.approx(rms((run - s.target)[keep]), rel=1e-6)


def test_each_short_run_is_divided_by_its_own_recording(pool):
    first, second = recorded_on_rail(on_rail()), recorded_on_rail(on_rail(0.0109), 100.0)

    def errors(*recordings):
        setting = setting_of(recordings, pool, DECLARED)
        found = setting.errors(at_nominal(setting.problem))
        return np.array([found.fit, found.choose, found.free_run])

    pooled = np.sqrt((errors(first) ** 2 + errors(second) ** 2) / 2.0)
    np.testing.assert_allclose(errors(first, second), pooled, rtol=1e-6)


def test_a_stretch_with_too_little_to_fit_is_no_run(pool):
    whole = bench_truth.free(duration=8.0)
    keep = np.ones(whole.t.size, dtype=bool)
    keep[10:30] = False
    gaps = ((float(whole.t[9]), float(whole.t[30])),)
    gap = replace(whole, t=whole.t[keep], position=whole.position[keep], gaps=gaps)
    setting = setting_of([gap], pool)
    assert [part.segment.t.size for part in setting.parts] == [770, 10]
    (run,) = setting.problem.segments
    assert run.t[0] == pytest.approx(whole.t[30])
    assert setting.model((), at_nominal(setting.problem)).errors.fit < 1e-3
