# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Thinned runs push the load as hard and as early as the full ones."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.data.thinning import (
    HELD_STEP,
    LONGEST_PERIOD,
    PERIODS,
    PHASE,
    coarse_period,
    longest_step,
    thinned,
)
from pam_ros.identification.fit.problem import Problem
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint

STEP = 6e-3


def recorded(t, stamps, command, position=None):
    position = np.zeros_like(t) if position is None else position
    recording = Recording('r', t, stamps, command, position)
    (segment,) = segments_of([recording])
    return segment


def wave(stamps):
    """Return a command that varies by far less than a hundredth of its range in a stride."""
    return 3e5 + 5e4 * np.sin(2 * np.pi * 0.2 * stamps) + 1e3 * np.sin(2 * np.pi * 1.0 * stamps)


def moments(stamps, values, start, end):
    """Return the integral of a held command from start to end, and its moment about the middle."""
    inside = stamps[(stamps > start) & (stamps < end)]
    edges = np.concatenate([[start], inside, [end]])
    held = np.array([values[max(np.flatnonzero(stamps <= e)[-1:], default=0)] for e in edges[:-1]])
    squares = (edges - 0.5 * (start + end)) ** 2
    return held @ np.diff(edges), held @ np.diff(squares) / 2.0


def uneven(rng, n):
    """Return n stamps at about 1 kHz that jitter."""
    return np.concatenate([[0.0], np.cumsum(1e-3 * rng.uniform(0.5, 1.5, n - 1))])


@pytest.mark.parametrize('seed', range(4))
@pytest.mark.parametrize('kind', ['smooth', 'steps', 'noise'])
def test_impulse_over_every_stride_is_kept(kind, seed):
    rng = np.random.default_rng(seed)
    t = np.arange(1500) * 1e-3
    stamps = uneven(rng, 1800)
    command = {
        'smooth': wave(stamps),
        'steps': wave(stamps) + 1e5 * (rng.random(stamps.size).cumsum() // 40 % 2),
        'noise': 3e5 + 1e4 * rng.standard_normal(stamps.size),
    }[kind]
    thin = thinned(recorded(t, stamps, command), STEP)
    spans = list(zip(thin.t[:-1], thin.t[1:], strict=True))
    full, arms = np.array([moments(stamps, command, *span) for span in spans]).T
    kept, _ = np.array([moments(thin.drive_t, thin.drive[:, 0], *span) for span in spans]).T
    # What a held mean cannot have is given to the adjacent strides, and no more than that.
    lent = np.abs(np.concatenate([[0.0], arms])[:-1]) + np.abs(np.append(arms[1:], 0.0))
    assert np.all(np.abs(kept - full) <= 0.5 * lent / STEP + 1e-9 * full)
    if kind == 'noise':  # every stride has a jump: the commands are as they were
        np.testing.assert_allclose(kept, full, rtol=1e-9)
    assert kept.sum() == pytest.approx(full.sum(), rel=1e-6)


def test_a_free_mass_goes_where_the_full_command_would_have_sent_it():
    stamps = np.arange(20_000) * 1e-3
    command = np.sin(2.0 * np.pi * 2.0 * stamps)
    thin = thinned(recorded(stamps, stamps, command), 10e-3)
    held = thin.drive[:, 0][np.searchsorted(thin.drive_t, stamps + 1e-9) - 1]
    means = command.reshape(-1, 10).mean(axis=1).repeat(10)

    def away(u):
        """Return how far it strays, but for a steady drift."""
        way = (np.cumsum(np.cumsum(u - command)) * 1e-6)[9::10]
        return np.std(way - np.polyval(np.polyfit(stamps[9::10], way, 1), stamps[9::10]))

    assert away(means) > 1e-6
    assert away(held) < 0.1 * away(means)


def zigzag(stamps):
    """Return a wave with ramps that are fast in every other second, and 40 times slower else."""
    fast = np.where(stamps % 2.0 < 1.0, 2e5, 5e3)
    return 3e5 + np.cumsum(fast * np.sign(np.sin(2.0 * np.pi * 2.0 * stamps))) * 1e-3


def test_a_ramp_has_two_means_in_a_long_stride():
    stamps = np.arange(8000) * 1e-3
    thin = thinned(recorded(stamps, stamps, zigzag(stamps)), 20e-3)
    np.testing.assert_array_equal(thin.t, stamps[::20])
    at, gaps = thin.drive_t[:-1], np.diff(thin.drive_t)
    # Where it turns, a stride may begin and end with the same command.
    assert np.median(gaps[(at % 2.0 > 0.05) & (at % 2.0 < 0.95)]) == pytest.approx(10e-3)
    assert gaps[(at % 2.0 > 1.05) & (at % 2.0 < 1.95)].min() == pytest.approx(20e-3)
    # A stride that is no longer than the usual one is not divided.
    usual = thinned(recorded(stamps, stamps, zigzag(stamps)), PERIODS[1])
    assert usual.drive_t.size <= usual.t.size + 10


def test_a_free_mass_follows_intervals_of_different_lengths():
    stamps = np.arange(20_000) * 1e-3
    command = zigzag(stamps)
    thin = thinned(recorded(stamps, stamps, command), 20e-3)
    held = thin.drive[:, 0][np.searchsorted(thin.drive_t, stamps + 1e-9) - 1]
    speed = np.concatenate([[0.0], np.cumsum(held - command)]) * 1e-3
    way = np.concatenate([[0.0], np.cumsum(speed[:-1])]) * 1e-3
    edges = np.unique(np.rint(np.concatenate([thin.drive_t, thin.t]) / 1e-3).astype(int))[3:-3]
    # The first interval of a ramp has nothing before it that compensates for its moment.
    moment = 2e5 * 10e-3**3 / 12.0
    assert np.ptp(way[edges]) < 1.5 * moment


def test_samples_are_every_nth_and_commands_fewer():
    t = np.arange(6000) * 1e-3
    segment = recorded(t, t, wave(t), 0.01 * np.sin(t))
    thin = thinned(segment, STEP)
    np.testing.assert_array_equal(thin.t, t[::6])
    np.testing.assert_array_equal(thin.target, segment.target[::6])
    np.testing.assert_array_equal(thin.fit, segment.fit[::6])
    assert thin.drive_t.size <= thin.t.size + 6
    assert np.all(np.diff(thin.drive_t) > 0.0)
    assert (thin.y0, thin.v0) == (segment.y0, segment.v0)


@pytest.mark.parametrize('period', [9.97e-3, 1e-2, 6.04e-3])
def test_a_period_is_one_step_though_it_is_slightly_longer_than_desired(period):
    t = np.arange(6000) * 1e-3
    thin = thinned(recorded(t, t, wave(t)), period)
    assert np.ptp(np.diff(thin.t)) < 1e-9
    assert thin.t[1] - thin.t[0] == pytest.approx(round(period, 3))
    assert thin.t[1] - thin.t[0] < longest_step(period) < 1.2 * period


def test_a_jump_keeps_its_stamp():
    t = np.arange(4000) * 1e-3
    jumps = (0.5004, 1.2337, 2.0)
    stamps = np.unique(np.concatenate([t, jumps]))
    command = wave(stamps) + 1e5 * np.searchsorted(jumps, stamps, side='right')
    thin = thinned(recorded(t, stamps, command), STEP)
    for jump in jumps:
        k = np.flatnonzero(thin.drive_t == jump)
        assert k.size == 1
        assert thin.drive[k[0], 0] == command[stamps == jump][0]
        assert thin.drive[k[0], 0] - thin.drive[k[0] - 1, 0] == pytest.approx(1e5, rel=0.02)


def test_few_commands_are_left_as_they_are():
    t = np.arange(4000) * 1e-3
    stamps = np.arange(0.0, 4.0, 0.25)
    command = 1e5 + 1e5 * (np.arange(stamps.size) % 2)
    thin = thinned(recorded(t, stamps, command), STEP)
    np.testing.assert_array_equal(thin.drive_t, stamps)
    np.testing.assert_array_equal(thin.drive[:, 0], command)


def test_what_is_sampled_coarsely_is_not_thinned():
    t = np.arange(400) * 1e-2
    segment = recorded(t, t, wave(t))
    thin = thinned(segment, STEP)
    np.testing.assert_array_equal(thin.t, t)
    np.testing.assert_array_equal(thin.drive, segment.drive)


def test_the_period_is_a_set_angle_of_the_rigs_fastest_oscillation():
    model = single_muscle_joint(Muscle(), Mass(mass=10.0))
    # Stiffness of Sarosi's law by hand, p in bar and kappa in percent: -dF/dkappa / l0 in N/m.
    k = []
    for p in (0.0, 6.0):
        percent = 100.0 * equilibrium(model, p * 1e5) / 0.4
        slope = (-4.35573 * p + 281.2237) * -0.32866 * np.exp(-0.32866 * percent) - 9.27035 * p
        k.append(-100.0 * slope / 0.4)
    expected = PHASE / np.sqrt(max(k) / 10.0)
    assert PERIODS[0] < expected < PERIODS[1]
    assert coarse_period(model) == pytest.approx(expected, rel=1e-9)


def test_the_period_stays_between_its_limits():
    heavy = single_muscle_joint(Muscle(), Mass(mass=40.0, mount='horizontal'))
    assert PERIODS[0] <= coarse_period(heavy) <= PERIODS[1]
    source = Muscle(a1=0.0, a2=0.0, a4=0.0, zeta=0.0)
    no_spring = single_muscle_joint(source, Mass(mass=5.0, mount='horizontal'))
    assert coarse_period(no_spring) == PERIODS[1] == coarse_period(no_spring, LONGEST_PERIOD)


def test_the_period_of_a_slow_rig_may_be_longer_if_there_are_many_samples():
    slow = single_muscle_joint(Muscle(), Mass(mass=20.0, mount='horizontal'))
    usual, longest = coarse_period(slow), coarse_period(slow, LONGEST_PERIOD)
    assert usual == PERIODS[1] < longest < LONGEST_PERIOD
    # Without gravity, four times the mass has half the frequency at the same stiffness.
    slower = single_muscle_joint(Muscle(), Mass(mass=80.0, mount='horizontal'))
    assert coarse_period(slower, LONGEST_PERIOD) == pytest.approx(2.0 * longest, rel=1e-9)


@pytest.mark.slow
@pytest.mark.needs_numba
def test_a_thinned_run_moves_like_the_full_one():
    model = single_muscle_joint(Muscle(), Mass(mass=20.0))
    rng = np.random.default_rng(0)
    t = np.arange(20_000) * 1e-3
    command = wave(t) + 1e4 * np.sin(2 * np.pi * 4.0 * t) + 4e4 * (uneven(rng, t.size) // 1.7 % 2)
    segment = recorded(t, t, command, np.full(t.size, equilibrium(model, command[0])))
    thin = thinned(segment, coarse_period(model))
    stride = round(thin.t[1] / t[1])
    assert stride >= 5

    def run(one, step):
        row = model.parameters().ravel()
        return Problem((one,), model.layout, model.active, row, (), step).predict([])[0]

    full = run(segment, 1e-3)[::stride]
    assert np.ptp(full) > 5e-3
    step = longest_step(coarse_period(model))
    coarse = run(thin, step)
    # Below the quietest sensor's noise; every tenth command alone comes half a stride late.
    error = np.sqrt(np.mean((coarse - full) ** 2))
    late = replace(thin, drive_t=t[::stride], drive=command[::stride, None])
    plain = run(late, step)
    assert error < 5e-6
    assert error < 0.05 * np.sqrt(np.mean((plain - full) ** 2))


def test_an_isometric_run_is_thinned_to_the_step_of_its_simulation():
    t = np.arange(4000) * 2e-3
    y = np.full(t.size, 0.02)
    recording = Recording('h', t, None, None, y, None, 5.0 * t, 1e5 + t, 'held')
    (segment,) = segments_of([recording])
    thin = thinned(segment, STEP)
    for name in ('t', 'target', 'fit', 'pressure', 'position', 'velocity'):
        np.testing.assert_array_equal(getattr(thin, name), getattr(segment, name)[::10])
    assert np.median(np.diff(thin.t)) == pytest.approx(HELD_STEP)


@pytest.mark.parametrize('rate', [1000, 100])
def test_a_command_that_repeats_the_one_before_is_left_out(rate):
    """A simulation would end a step at it, for nothing."""
    t = np.arange(4 * rate) / rate
    at = np.arange(0.0, 4.0, 0.25)
    command = 1e5 + 4e4 * (np.searchsorted(at, t + 1e-9) % 3)
    thin = thinned(recorded(t, t, command), 1e-2)
    np.testing.assert_allclose(thin.drive_t, at, atol=1e-12)
    np.testing.assert_allclose(thin.drive[:, 0], command[:: rate // 4], rtol=1e-9)


def test_of_two_muscles_a_command_is_kept_if_it_changes_in_one():
    t = np.arange(100) * 1e-2
    command = np.column_stack([np.where(t < 0.3, 1e5, 2e5), np.where(t < 0.6, 2e5, 1e5)])
    of_joint = replace(recorded(t, t, command[:, 0]), drive=command)
    thin = thinned(of_joint, 1e-2)
    np.testing.assert_allclose(thin.drive_t, [0.0, 0.3, 0.6], atol=1e-12)
    np.testing.assert_array_equal(thin.drive, [[1e5, 2e5], [2e5, 2e5], [2e5, 1e5]])


def test_where_a_measured_pressure_jumps_all_samples_are_kept():
    """Two delays that differ by a sampling period are told apart, and it costs few samples."""
    t = np.arange(20_000) * 1e-3
    command = 1e5 * (1.0 + (t // 2.003 % 2))
    for delay in (5e-3, 6e-3):
        late = 1e5 * (1.0 + ((t - delay) // 2.003 % 2)) + np.random.default_rng(0).normal(
            0.0, 300.0, t.size
        )
        recording = Recording('r', t, t, command, kind='pressure', pressure=late)
        (segment,) = segments_of([recording])
        thin = thinned(segment, STEP)
        assert thin.t.size < 1.05 * t.size / 6
        jumps = np.flatnonzero(np.abs(np.diff(late)) > 5e4)
        kept = np.isin(t, thin.t)
        assert jumps.size >= 9
        assert kept[jumps].all()
        assert kept[jumps + 1].all()
