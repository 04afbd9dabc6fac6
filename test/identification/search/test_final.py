# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fits of every sample that a verdict may rest on, compared with the truth plant's numbers."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.data.thinning import LONGEST_PERIOD, coarse_period
from pam_ros.identification.fit.intervals import covariance
from pam_ros.identification.fit.unknowns import OF_RUNS
from pam_ros.identification.search.criteria import BUDGET, CRITERIA
from pam_ros.identification.search.final import (
    STEP,
    STEPS,
    errors_of,
    fit_finally,
    short_step,
    simulated,
)
from pam_ros.identification.search.setting import simulate_on
from pam_ros.identification.search.starts import guessed
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.loads import Mass
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import single_muscle_joint
from support import bench_truth
from support.searches import FILL, NOISE, found_in
from truth import effect

pytestmark = pytest.mark.needs_numba


def errors(known, ends, found):
    """Return the errors of a final fit before the part that judges, and over it."""
    return errors_of(simulated(known, ends.parts, found.setting), ends.parts)


def test_every_sample_before_those_that_judge_is_fitted(found, ends, recording):
    known = int(np.count_nonzero(recording.t < CRITERIA.choose * recording.t[-1]))
    for solution in (ends.nominal, ends.retuned, ends.augmented):
        (run,) = solution.problem.segments
        assert run.t.size == solution.r.size == known
        assert solution.problem.step == STEP
    assert found.setting.thin[0].segment.t.size < 0.6 * recording.t.size


def test_errors_fall_from_model_to_model_to_the_noise_where_nothing_was_fitted(found, ends):
    nominal, retuned, augmented = (
        errors(one, ends, found) for one in (ends.nominal, ends.retuned, ends.augmented)
    )
    assert nominal[0] > retuned[0] > 3.0 * NOISE
    assert retuned[1] > 3.0 * NOISE
    assert augmented == pytest.approx((NOISE, NOISE), rel=0.1)


def test_the_lag_is_within_three_standard_errors_of_the_true_one(ends):
    known = ends.augmented
    k = [unknown.name for unknown in known.problem.unknowns].index('effects.pressure_lag.fill')
    error = np.sqrt(covariance(known, known.most_likely())[k, k])
    low, high = (
        known.problem.unknowns[k].value(known.u[k] + side * error) for side in (-3.0, 3.0)
    )
    assert low < FILL < high
    assert high - low < 0.01 * FILL


def test_of_the_configured_model_only_the_starts_are_fitted(found, ends):
    problem = ends.nominal.problem
    assert [k.name for k in problem.unknowns] == ['y0[0]', 'v0[0]']
    np.testing.assert_array_equal(
        problem.row_at(ends.nominal.u), found.setting.joint.parameters().ravel()
    )
    (part,) = found.setting.parts
    s = part.segment
    y0, v0 = (ends.nominal.value(k.name) for k in problem.unknowns)
    run = simulate(found.setting.joint, s.t, s.drive, s.drive_t, position=y0, velocity=v0).position
    e = run - s.target
    expected = [float(np.sqrt(np.mean(e[k] ** 2))) for k in (part.known, part.judge)]
    assert errors(ends.nominal, ends, found) == pytest.approx(expected, rel=1e-3)


def test_nothing_sees_what_judges(recording, pool, ends):
    spoiled = fit_finally(found_in([recording], pool, spoil=True))
    np.testing.assert_array_equal(spoiled.augmented.u, ends.augmented.u)


def test_at_a_prescribed_length_nothing_sees_what_judges(pool):
    """Neither levels, nor starts that effects read from residuals, nor fits."""
    recordings = [at_one_length(k, 0.08, offset) for k, offset in enumerate((5.0, 0.0))]
    pairs = [found_in(recordings, pool, name='hysteresis', spoil=spoil) for spoil in (False, True)]
    there, gone = pairs
    (plain, spoiled) = (one.setting.parts[0].segment.target for one in pairs)
    assert np.any(plain != spoiled)
    assert [k.scale for k in there.setting.problem.unknowns] == [
        k.scale for k in gone.setting.problem.unknowns
    ]
    periodic = there.setting.places['periodic_disturbance']
    starts = guessed(there.retuned, periodic)
    assert starts
    assert starts == guessed(gone.retuned, periodic)
    np.testing.assert_array_equal(fit_finally(there).augmented.u, fit_finally(gone).augmented.u)


def test_where_nothing_judges_there_is_no_such_error(recording, pool):
    found = found_in([recording], pool, 0.7, 1.0)
    ends = fit_finally(found)
    known, judged = errors(ends.augmented, ends, found)
    assert known == pytest.approx(NOISE, rel=0.1)
    assert np.isnan(judged)
    assert ends.augmented.r.size == recording.t.size


def test_a_stretch_that_only_choices_saw_is_fitted_from_a_start_of_its_own(recording, pool):
    """There is a pause from 13.6 s on, and after it a stretch of 10 samples, too short."""
    keep = np.ones(recording.t.size, dtype=bool)
    keep[3400:3600] = False
    keep[3610:3700] = False
    gaps = tuple(
        (float(recording.t[a - 1]), float(recording.t[b])) for a, b in ((3400, 3600), (3610, 3700))
    )
    parted = replace(recording, t=recording.t[keep], position=recording.position[keep], gaps=gaps)
    found = found_in([parted], pool)
    assert len(found.setting.problem.segments) == 1
    ends = fit_finally(found)
    assert [s.t.size for s in ends.augmented.problem.segments] == [3400, 800]
    assert {'y0[1]', 'v0[1]'} < {k.name for k in ends.augmented.problem.unknowns}
    assert errors(ends.augmented, ends, found)[1] == pytest.approx(NOISE, rel=0.1)


def test_at_a_prescribed_length_blocks_are_fitted_and_the_blocks_between_them_judge(pool):
    recordings = [bench_truth.held(effect('slack'), seed=k, name=f'{k}.csv') for k in (1, 2)]
    found = found_in(recordings, pool, name='slack')
    ends = fit_finally(found)
    known = [int(np.count_nonzero(part.known)) for part in found.setting.parts]
    assert [stamps.size for stamps in ends.augmented.problem.stamps()] == known
    assert ends.nominal.problem.unknowns == ()
    for name in ('nominal', 'retuned'):
        assert min(errors(getattr(ends, name), ends, found)) > 3.0 * found.setting.noise
    after = errors(ends.augmented, ends, found)
    assert after == pytest.approx((found.setting.noise,) * 2, rel=0.2)


def test_of_many_recordings_some_are_searched_and_all_are_fitted(pool):
    lag = effect('pressure_lag', fill_s=FILL, vent_s=FILL)
    runs = [bench_truth.free(lag, seed=k, duration=10.0, name=f'{k}.csv') for k in range(5)]
    whole = found_in(runs, pool)
    size = whole.setting.thin[0].segment.t.size
    assert len(whole.setting.searched) == 5
    # The third decides, and is always looked at.
    for room, chosen in (
        (4.1, (0, 1, 3, 4, 2)),
        (3.9, (0, 1, 3, 2)),
        (2.5, (0, 1, 2)),
        (0.5, (0, 2)),
    ):
        setting = replace(whole.setting, budget=replace(BUDGET, most=int(room * size)))
        names = [part.segment.name for part in setting.searched]
        assert names == [f'{k}.csv' for k in chosen], room
    found = found_in(runs, pool, budget=replace(BUDGET, most=int(2.5 * size)))
    assert len(found.setting.problem.segments) == 2
    known = fit_finally(found).augmented
    assert len(known.problem.segments) == 5
    assert known.value('effects.pressure_lag.fill') == pytest.approx(FILL, rel=0.02)
    assert known.noise == pytest.approx(NOISE, rel=0.1)


def test_a_slow_rig_is_simulated_with_longer_steps():
    slow = single_muscle_joint(Muscle(), Mass(mass=80.0, mount='horizontal'))
    fast = single_muscle_joint(Muscle(), Mass(mass=5.0))
    short, long = (short_step(coarse_period(rig, LONGEST_PERIOD)) for rig in (fast, slow))
    assert short == STEP < long == coarse_period(slow, LONGEST_PERIOD) / STEPS
    t = np.arange(0.0, 10.0, 0.01)
    command = 2e5 + 1e5 * (np.sin(2.0 * t) > 0.0)
    begin = float(equilibrium(slow, 2e5))
    run, exact = (
        simulate(slow, t, command, position=begin, step=step).position for step in (long, 1e-4)
    )
    assert np.max(np.abs(run - exact)) < 1e-7 * np.ptp(exact)


def test_without_an_effect_the_last_model_is_the_retuned_one(found):
    ends = fit_finally(replace(found, best=found.retuned))
    assert ends.augmented is ends.retuned


def test_different_levels_of_repeats_are_explained_and_the_last_one_by_the_law(pool):
    """The force cell's zero wanders by 9 N; constants would take it for their own."""
    offsets = (9.0, 3.0, 0.0)
    recordings = [
        at_one_length(k, kappa, offset)
        for k, (kappa, offset) in enumerate((kappa, o) for kappa in (0.05, 0.12) for o in offsets)
    ]
    found = found_in(recordings, pool, name='slack')
    retuned = fit_finally(found).retuned
    assert [retuned.value(f'level[{k}]') for k in (0, 1, 3, 4)] == pytest.approx(
        [9.0, 3.0, 9.0, 3.0], abs=1.0
    )
    assert {'level[2]', 'level[5]'}.isdisjoint(k.name for k in retuned.problem.unknowns)
    later = segments_of([at_one_length(9, 0.12, 0.0)])
    (run,) = simulate_on(retuned, later, without=OF_RUNS)
    assert np.mean(run - later[0].target) == pytest.approx(0.0, abs=0.7)


def at_one_length(seed, kappa, offset):
    """Return 12 s at one length of the muscle that is configured, by its own equation."""
    muscle = bench_truth.nominal().muscle
    rng = np.random.default_rng(seed)
    t = np.arange(600) / 50.0
    pressure = 3e5 + 1.5e5 * np.sin(t + rng.uniform(0.0, 6.0))
    force = muscle.force(pressure, kappa) + offset + rng.standard_normal(t.size)
    position = np.full(t.size, kappa * muscle.l0)
    return Recording(f'{seed}', t, None, None, position, None, force, pressure, 'held')
