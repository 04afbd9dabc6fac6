# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is learned from motion: right on the truth plant, and nothing where nothing is missing."""

import numpy as np
import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.learning.learning_tuning import LearningTuning
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.effects import CoulombFriction, PressureLag
from support.closed_loop import LAG, close_loop, nominal, sine_target, step_target, truth
from support.kinds import EACH_KIND, ONE, PAIR, rms

pytestmark = pytest.mark.needs_numba

FRICTION = (CoulombFriction(level=15.0, breakaway=25.0, stribeck_speed=0.01),)
ARMS = {ONE: 1.0, PAIR: 0.08}  # of all muscles together, m on a joint that turns


def swung(kind, plant, seconds=12.0, effects=(), **gains):
    joint = kind.nominal(effects)
    law = SlidingMode(joint, Gains.for_joint(joint, **gains))
    return law, kind.close(law, kind.truth(plant, seed=5), kind.swing, seconds)


@pytest.mark.slow
@EACH_KIND
def test_nothing_is_learned_where_nothing_is_missing(kind):
    law, run = swung(kind, 'nominal', 8.0)
    assert law.learned.weight == 0.0
    assert np.all(run.terms['learned'] == 0.0)
    assert rms(kind, run) < 0.02
    # Nor does the loop become faster: the error does not ask for it.
    assert run.terms['bandwidth'][-1] == pytest.approx(law.gains.bandwidth, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize('rest', [0.3, 1.0, 2.8, 3.4, 4.0])
def test_a_load_that_nobody_configured_is_not_taken_for_anything_else(rest):
    # Nor is the pressure known at the start, so that the load jumps before it is moved.
    law, plant = SlidingMode(ONE.nominal()), ONE.truth('payload', noise=0.0)
    run = ONE.close(law, plant, step_target(0.02, at=rest), rest + 2.5, is_pressure_known=False)
    assert np.max(np.abs(run.terms['learned'])) < 1e-3
    assert np.max(np.abs(run.error[run.last(0.5)])) < 0.02e-3


@pytest.mark.slow
@pytest.mark.parametrize(
    ('kind', 'level', 'bandwidth', 'most'),
    [(ONE, 40.0, 30.0, 0.15), (PAIR, 15.0, 40.0, 0.06)],
    ids=str,
)
def test_hysteresis_is_learned_and_the_bandwidth_grows(kind, level, bandwidth, most):
    """N in each muscle; 1/s; mm or degrees."""
    law, run = swung(kind, 'hysteresis')
    assert law.learned.friction == pytest.approx(level * ARMS[kind], rel=0.1)
    assert max(law.learned.lag) < 5e-3
    assert run.terms['bandwidth'][-1] > bandwidth
    without = swung(kind, 'hysteresis', 8.0, learning=False)[1]
    assert rms(kind, run) < most < 0.2 * rms(kind, without)


@pytest.mark.slow
@pytest.mark.parametrize(
    ('kind', 'level', 'within', 'most'),
    [(ONE, 15.0, 4.0, 0.15), (PAIR, 0.15, 0.05, 0.08)],
    ids=str,
)
def test_friction_is_learned(kind, level, within, most):
    """N, or N m at the pivot; mm or degrees."""
    law, run = swung(kind, 'friction')
    assert law.learned.friction == pytest.approx(level, abs=within)
    assert rms(kind, run) < most
    assert rms(kind, run) < 0.9 * rms(kind, swung(kind, 'friction', 8.0, learning=False)[1])


@pytest.mark.slow
@pytest.mark.parametrize(
    ('kind', 'within', 'bandwidth', 'most', 'share'),
    [(ONE, (0.02, 0.09), 20.0, 0.25, 0.9), (PAIR, (0.04, 0.07), 30.0, 0.1, 0.4)],
    ids=str,
)
def test_a_lag_is_learned_and_the_bandwidth_stays(kind, within, bandwidth, most, share):
    """In s; 1/s; mm or degrees: of a pair it is 0.04 to 0.08 with other noise."""
    law, run = swung(kind, 'lag')
    assert within[0] < 0.5 * sum(law.learned.lag) < within[1]
    assert run.terms['bandwidth'][-1] < bandwidth
    without = swung(kind, 'lag', 8.0, learning=False)[1]
    assert rms(kind, run) < most < share * rms(kind, without)


@pytest.mark.slow
@pytest.mark.parametrize(('kind', 'most'), [(ONE, 0.09), (PAIR, 0.04)], ids=str)
def test_a_lag_is_learned_beside_a_configured_dead_zone(kind, most):
    """The lag is 50/70 ms; mm or degrees."""
    law, run = swung(kind, 'dead zone', effects=(PressureLag(dead_zone=6e3),))
    assert 0.02 < 0.5 * sum(law.learned.lag) < 0.09
    assert rms(kind, run) < most
    assert rms(kind, run) < 0.8 * rms(kind, swung(kind, 'dead zone')[1])


@EACH_KIND
def test_a_configured_lag_leaves_nothing_to_learn(kind):
    law, run = swung(kind, 'lag', 8.0, effects=LAG)
    assert law.learned.lag is None
    assert np.max(np.abs(run.terms['learned'])) < 3.0 * ARMS[kind]
    assert rms(kind, run) < (0.05 if kind is ONE else 0.02)


@pytest.mark.slow
def test_of_configured_friction_only_the_part_at_rest_is_learned():
    law, run = swung(ONE, 'friction', effects=FRICTION)
    assert law.learned.friction < 5.0
    assert 5.0 < law.learned.breakaway < 15.0
    assert np.max(np.abs(run.terms['learned'][run.last(6.0)])) < 15.0
    # What is fed forward explains the motion, so that the loop is fast, too.
    assert run.terms['bandwidth'][-1] > 40.0
    _, learned = swung(ONE, 'friction')
    assert rms(ONE, run) < 0.8 * rms(ONE, learned) < 0.12


@pytest.mark.release
@pytest.mark.slow
@pytest.mark.parametrize('mass', [5.0, 10.0])
def test_configured_friction_of_a_light_load_is_about_as_good_as_learned(mass):
    """A light load jumps at the reversal, so that runs differ by half: the mean of five counts."""
    errors = {}
    for effects in ((), FRICTION):
        squares = []
        for seed in range(5):
            law, plant = SlidingMode(nominal(mass, effects)), truth('friction', mass, seed=seed)
            run = close_loop(law, plant, sine_target(0.01, 0.5), 16.0)
            squares.append(np.mean(run.error[run.last(4.0)] ** 2))
        errors[effects] = np.sqrt(np.mean(squares))
    assert errors[FRICTION] < 1.2 * errors[()] < 0.7e-3


@pytest.mark.slow
def test_a_lag_that_nobody_configured_is_learned_beside_configured_friction():
    law, run = swung(ONE, 'all', 20.0, effects=FRICTION)
    # 50 and 70 ms, and a dead time of 10 ms; the hysteresis lags behind the motion, too.
    assert 0.02 < 0.5 * sum(law.learned.lag) < 0.12
    assert rms(ONE, run) < 1.0


@pytest.mark.slow
@EACH_KIND
def test_of_all_at_once_enough_is_learned_within_bounds(kind):
    _, run = swung(kind, 'all')
    assert rms(kind, run) < (1.0 if kind is ONE else 0.2)
    assert np.max(np.abs(run.terms['learned'])) <= LearningTuning().most * ARMS[kind]


@pytest.mark.slow
@pytest.mark.parametrize(
    ('kind', 'plant', 'share'),
    [
        (ONE, 'lag', 0.2),
        (ONE, 'all', 0.2),
        (PAIR, 'friction', 0.4),
    ],
    ids=str,
)
def test_what_was_learned_is_kept_when_control_starts_again(kind, plant, share):
    """After ~/enable the error is small at once; a new law has learned nothing."""
    law, first = swung(kind, plant)
    assert law.learned.weight > 0.3
    again = kind.close(law, kind.truth(plant, seed=6), kind.swing, 4.0)
    assert law.learned.weight > 0.3
    # The reference jumps to its speed at the start, which moves the load in any case.
    after, before = (run.error[(run.t > 0.5) & (run.t <= 1.5)] for run in (again, first))
    assert np.sqrt(np.mean(after**2)) < share * np.sqrt(np.mean(before**2))


@pytest.mark.slow
def test_another_rig_after_a_start_is_learned_again():
    law, _ = swung(ONE, 'friction')
    ONE.close(law, ONE.truth('nominal', seed=6), ONE.swing, 8.0)
    run = ONE.close(law, ONE.truth('hysteresis', seed=6), ONE.swing, 8.0)
    fresh = swung(ONE, 'hysteresis', 8.0)[1]
    assert rms(ONE, run) < 1.4 * rms(ONE, fresh)


@pytest.mark.slow
def test_a_lag_that_has_gone_is_not_used_any_more():
    law, _ = swung(ONE, 'lag')
    run = ONE.close(law, ONE.truth('nominal', seed=6), ONE.swing, 6.0)
    assert law.learned.weight < 0.05
    assert rms(ONE, run, 1.0) < 0.02


@pytest.mark.slow
def test_a_lag_that_explains_too_little_is_dropped_and_later_forgotten():
    """The friction of the other rig looks like the lag, until it is learned."""
    law, _ = swung(PAIR, 'lag', 8.0)
    assert law.learned.dropped_lag is None
    PAIR.close(law, PAIR.truth('friction', seed=6), PAIR.swing, 8.0)
    after = law.learned
    assert max(after.dropped_lag) > 0.02 > max(after.lag)
    PAIR.close(law, PAIR.truth('lag', seed=6), PAIR.swing, 8.0)
    assert law.learned.dropped_lag is None
    assert max(law.learned.lag) > 0.02


def test_what_is_configured_not_to_be_learned_is_no_number():
    joint = ONE.nominal()
    assert SlidingMode(joint, Gains.for_joint(joint, learning=False)).learned is None
    still = SlidingMode(joint).learned
    assert (still.motion, still.weight, still.dropped_lag) == (0.0, 0.0, None)


def test_another_load_after_a_start_is_no_friction():
    law, _ = swung(ONE, 'payload', 4.0)
    run = ONE.close(law, ONE.truth('nominal', seed=6), ONE.swing, 6.0)
    assert np.max(np.abs(run.terms['learned'])) < 3.0
    assert rms(ONE, run) < 0.02


@pytest.mark.slow
def test_a_loop_that_a_sudden_dead_time_makes_unstable_forgets_and_comes_to_rest():
    """What was learned before lets the loop be too fast; the command goes from limit to limit."""
    law, _ = swung(ONE, 'friction')
    assert law.learned.restarts == 0
    run = ONE.close(law, ONE.truth('dead time', seed=6), ONE.step, 10.0)
    assert (np.min(run.pressure), np.max(run.pressure)) == (0.0, 600e3)
    assert law.learned.restarts >= 1
    assert np.max(np.abs(run.error[run.last(2.0)])) < 2.0 * law.gains.rest_tolerance
