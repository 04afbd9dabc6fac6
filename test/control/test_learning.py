# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is learned from motion: right on the truth plant, and nothing where nothing is missing."""

import numpy as np
import pytest

from pam_ros.control.features import FeatureTuning
from pam_ros.control.gains import Gains
from pam_ros.control.learning import LearningTuning
from pam_ros.control.sliding_mode import SlidingMode
from support.closed_loop import LAG, close_loop, declared, sine_target, step_target, truth

pytestmark = pytest.mark.needs_numba

REACHES = FeatureTuning().reaches


def swung(plant, seconds=14.0, effects=None, gains=None):
    law = SlidingMode(declared(effects=effects), gains or Gains())
    return law, close_loop(law, truth(plant), sine_target(0.01, 0.5), seconds)


def rms(run, seconds=4.0):
    return np.sqrt(np.mean(run.error[run.last(seconds)] ** 2))


def test_nothing_is_learned_where_nothing_is_missing():
    law, run = swung('nominal', 8.0)
    assert law._learner.trust == 0.0
    assert np.all(run.terms['learned'] == 0.0)
    assert rms(run) < 0.02e-3


@pytest.mark.slow
@pytest.mark.parametrize('rest', [0.3, 1.0, 2.8, 3.4, 4.0])
def test_a_load_that_nobody_declared_is_not_taken_for_anything_else(rest):
    # Nor is the pressure known at the start, so that the load jumps before it is moved.
    law, plant = SlidingMode(declared(), Gains()), truth('payload', noise=0.0)
    moves = step_target(0.02, at=rest)
    run = close_loop(law, plant, moves, rest + 2.5, is_pressure_known=False)
    assert np.max(np.abs(run.terms['learned'])) < 1e-3
    assert np.max(np.abs(run.error[run.last(0.5)])) < 0.02e-3


@pytest.mark.slow
def test_hysteresis_is_learned_and_the_bandwidth_grows():
    law, run = swung('hysteresis')
    weights = law._learner._weights[: len(REACHES)]
    assert weights.sum() == pytest.approx(40.0, rel=0.1)
    assert max(law._learner.lag) < 5e-3
    assert run.terms['bandwidth'][-1] > 30.0
    without = swung('hysteresis', 8.0, gains=Gains(learning=False))[1]
    assert rms(run) < 0.15e-3 < 0.2 * rms(without)


def test_friction_is_learned():
    law, run = swung('friction')
    assert law._learner._weights[0] == pytest.approx(15.0, abs=4.0)
    assert rms(run) < 0.15e-3


@pytest.mark.slow
def test_a_lag_is_learned_and_the_bandwidth_stays():
    law, run = swung('lag')
    fill, vent = law._learner.lag
    assert 0.02 < 0.5 * (fill + vent) < 0.09
    assert run.terms['bandwidth'][-1] < 20.0
    assert rms(run) < 0.25e-3


def test_a_declared_lag_leaves_nothing_to_learn():
    law, run = swung('lag', 8.0, effects=LAG)
    assert law._learner.lag == (0.0, 0.0)
    assert np.max(np.abs(run.terms['learned'])) < 3.0
    assert rms(run) < 0.05e-3


@pytest.mark.slow
def test_declared_friction_is_not_learned_again():
    friction = {'coulomb_friction': {'level': 15.0, 'breakaway': 25.0, 'stribeck_speed': 0.01}}
    _, run = swung('friction', effects=friction)
    assert np.max(np.abs(run.terms['learned'][run.last(6.0)])) < 5.0
    assert rms(run) < 0.55e-3


def test_what_is_fed_forward_is_bounded():
    _, run = swung('all', 10.0)
    assert np.max(np.abs(run.terms['learned'])) <= LearningTuning().most
