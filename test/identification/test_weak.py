# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The weak form: exact for polynomials, as quiet as the sensor, and not lost far from home."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import EFFECTS
from pam_ros.identification.candidate import extended, fitted
from pam_ros.identification.data.noise import noise_of
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.data.thinning import coarse_step, thinned
from pam_ros.identification.retuning import problem_of
from pam_ros.identification.solve import solve
from pam_ros.identification.weak import MOMENTS, at_weak, motion_of, weak_fits, weak_starts
from pam_ros.recording.recording import Recording
from support import bench_truth
from truth import effect

KNOWN = {e.name: e for e in EFFECTS}
MODEL = bench_truth.declared(off=[0.03, -0.03, 0.0, 0.03, 0.0, 0.03])


def measured(t, y):
    """Return a run whose command says nothing, in full and every third sample of it."""
    recording = Recording('r', t, t, np.sin(t), y, None, None, None, 'free')
    (full,) = segments_of([recording], keep_back=True)
    return full, thinned(full, 3.0 * float(np.median(np.diff(t))))


@pytest.mark.parametrize('degree', range(MOMENTS))
@pytest.mark.parametrize('jitter', [0.0, 0.3])
def test_integrals_of_polynomials_are_exact(degree, jitter):
    rng = np.random.default_rng(degree)
    t = 4e-3 * (np.arange(1500) + jitter * rng.uniform(-1.0, 1.0, 1500))
    # Of any degree below that of the moments: a parabola of a at most, so its integral over an
    # interval is taken at its middle and its ends, and its moment likewise.
    y = ((t - 3.0) / 3.0) ** degree
    full, thin = measured(t, y)
    motion = motion_of(full, thin, 1e-6)

    def a(s):
        return degree * (degree - 1) * ((s - 3.0) / 3.0) ** max(degree - 2, 0) / 9.0

    h = np.diff(thin.t)
    middle = 0.5 * (thin.t[1:] + thin.t[:-1])
    # By the midpoint rule, as the kernel takes it.
    out = np.stack([h * a(middle), np.zeros(h.size)], axis=1)
    found = np.einsum('knj,knj->k', out[motion.rows], motion.weights)
    np.testing.assert_allclose(found, motion.wanted, atol=1e-9 * np.ptp(y) + 1e-12)


@pytest.mark.parametrize('rate', [10.0, 50.0, 100.0])
def test_bumps_are_wider_where_samples_are_few(rate):
    t = np.arange(0.0, 120.0, 1.0 / rate)
    noise = 2e-5 * np.random.default_rng(1).standard_normal(t.size)
    (full,) = segments_of([Recording('r', t, t, t, noise, None, None, None, 'free')], True)
    motion = motion_of(full, thinned(full, 10e-3), 2e-5)
    assert np.std(motion.wanted) == pytest.approx(2e-5, rel=0.2)
    assert motion.wanted.size > 20


@pytest.mark.parametrize('samples', [4, 6, 15, 40])
def test_a_short_run_has_no_bumps_or_few(samples):
    t = np.arange(samples) * 1e-2
    full, _ = measured(t, np.sin(t))
    motion = motion_of(full, full, 1e-6)
    assert motion.wanted.size <= samples // 7
    assert np.all(np.isfinite(motion.wanted))


def test_no_bump_reaches_over_a_hole():
    t = np.arange(0.0, 20.0, 5e-3)
    t = t[(t < 10.0) | (t > 10.12)]
    y = 1e-3 * np.sin(3.0 * t)
    (full,) = segments_of([Recording('r', t, t, t, y, None, None, None, 'free')], False)
    motion = motion_of(full, full, 1e-6)
    covered = t[np.clip(motion.rows, 0, t.size - 1)]
    assert not np.any((covered.min(axis=1) < 9.97) & (covered.max(axis=1) > 10.15))
    assert np.abs(motion.wanted).max() < 1e-2


def test_the_noise_of_each_integral_is_that_of_the_position():
    t = np.arange(0.0, 60.0, 5e-3)
    noise = 2e-5 * np.random.default_rng(1).standard_normal(t.size)
    motion = motion_of(*measured(t, noise), 2e-5)
    assert np.std(motion.wanted) == pytest.approx(2e-5, rel=0.05)
    assert not motion.moving.any()


def test_a_bump_counts_as_moving_where_the_rig_goes_one_way():
    t = np.arange(0.0, 20.0, 5e-3)
    y = np.where(t < 10.0, 2e-3 * np.sin(0.5 * np.pi * t), 0.0)
    motion = motion_of(*measured(t, y), 1e-6)
    middles = 0.5 * (t[1:] + t[:-1])[3 * motion.rows.mean(axis=1).astype(int)]
    assert not motion.moving[middles > 10.2].any()
    away = np.abs((middles % 2.0) - 1.0) > 0.3  # turns are at 1, 3, 5... s
    assert motion.moving[(middles < 9.8) & away].mean() > 0.95
    assert not motion.moving[(middles < 9.8) & (np.abs((middles % 2.0) - 1.0) < 0.02)].any()


def test_samples_kept_back_are_unseen():
    t = np.arange(0.0, 60.0, 5e-3)
    y = 1e-2 * np.sin(3.0 * t)
    full, thin = measured(t, y)
    assert not full.fit.all()
    spoilt = replace(full, target=np.where(full.fit, y, np.nan))
    seen, blind = motion_of(full, thin, 1e-6), motion_of(full, thin, 1e-6)
    np.testing.assert_array_equal(seen.wanted, blind.wanted)
    bumps = np.isnan(spoilt.target[np.clip(3 * seen.rows, 0, t.size - 1)]).any(axis=1)
    assert not bumps.any()


@pytest.fixture(scope='module')
def pool():
    """Return threads."""
    with ThreadPoolExecutor() as threads:
        yield threads


def prepared(*effects, model=MODEL, **settings):
    """Return re-tuned fit, motions and noise of the truth plant with *effects*."""
    recording = bench_truth.free(*effects, **{'seed': 5, 'duration': 40.0, **settings})
    full = segments_of([recording], keep_back=True)
    noise = noise_of([(s.t, s.target) for s in full])
    thin = [thinned(s, coarse_step(model)) for s in full]
    problem = problem_of(model, thin, noise, coarse_step(model), 1)
    parent = fitted((), solve(problem, np.zeros(len(problem.unknowns))))
    motions = [motion_of(f, s, noise.sigma) for f, s in zip(full, thin, strict=True)]
    return parent, motions, noise


def rms(solution):
    return float(np.sqrt(np.mean(solution.r**2)))


@pytest.mark.slow
@pytest.mark.needs_numba
def test_a_right_model_leaves_the_sensors_noise(pool):
    parent, motions, noise = prepared(rate=250.0)
    for weak in weak_fits(parent, motions, pool):
        assert 0.5 * noise.sigma < rms(weak) < 1.5 * noise.sigma


@pytest.mark.slow
@pytest.mark.needs_numba
def test_where_friction_sticks_a_start_is_found_that_no_constant_start_comes_near(pool):
    parent, motions, _ = prepared(effect('coulomb_friction'), rate=250.0)
    friction = KNOWN['coulomb_friction']
    known = weak_fits(parent, motions, pool)
    assert [weak.problem.moving for weak in known] == [False, True]
    both = [friction, KNOWN['payload']]
    starts = weak_starts(parent, MODEL, both, {e.name: () for e in both}, known, pool)
    led = starts['coulomb_friction']
    assert led
    off = min(np.sqrt(np.mean(problem.residuals(u) ** 2)) for problem, u in led)
    for start in friction.fit_starts:
        problem, added = extended(parent.solution.problem, MODEL, friction, start)
        r = problem.residuals(np.concatenate([parent.solution.u, added]))
        assert off < 0.5 * np.sqrt(np.mean(r**2))
    # A payload explains next to nothing of it and leads nowhere.
    assert len(starts['payload']) < 2


@pytest.mark.needs_numba
def test_a_fit_that_went_astray_comes_back(pool):
    parent, motions, noise = prepared(rate=250.0)
    u = parent.solution.u.copy()
    u[: len(u) - 2] += 1.5
    problem = parent.solution.problem
    astray = fitted((), solve(problem, u, 0))
    assert astray.fit_error > 20.0 * noise.sigma
    back = [at_weak(astray, weak) for weak in weak_fits(astray, motions, pool)]
    assert min(fit.fit_error for fit in back) < 1.1 * parent.fit_error
