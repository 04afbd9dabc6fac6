# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is learned of a pair from its motion, on the truth plant."""

import math

import numpy as np
import pytest

from pam_ros.control.features import FeatureTuning
from pam_ros.control.gains import Gains
from pam_ros.control.learning import LearningTuning
from pam_ros.control.sliding_mode import SlidingMode
from support.pair_loop import LAG, close_pair, declared
from truth.pair import pair_plant

pytestmark = pytest.mark.needs_numba

DEGREE = math.radians(1.0)
ELEMENTS = len(FeatureTuning().reaches)
ARMS = 0.08  # m, of both muscles together


def sine(t):
    return 15.0 * DEGREE * math.sin(math.pi * t)


def swung(plant, seconds=12.0, effects=None, **gains):
    law = SlidingMode(declared(effects), Gains.turning(**gains))
    return law, close_pair(law, pair_plant(plant, seed=5), sine, seconds)


def rms(run, seconds=4.0):
    return np.sqrt(np.mean(run.error[run.last(seconds)] ** 2))


@pytest.mark.slow
def test_nothing_is_learned_where_nothing_is_missing():
    law, run = swung('nominal', 8.0)
    assert law._learner.trust == 0.0
    assert np.all(run.terms['learned'] == 0.0)
    assert rms(run) < 0.02 * DEGREE
    without = swung('nominal', 8.0, learning=False)[1]
    assert run.pressure.tobytes() == without.pressure.tobytes()


@pytest.mark.slow
def test_hysteresis_of_both_muscles_is_learned_and_the_bandwidth_grows():
    law, run = swung('hysteresis')
    assert law._learner._weights[:ELEMENTS].sum() == pytest.approx(15.0 * ARMS, rel=0.1)
    assert max(law._learner.lag) < 5e-3
    assert run.terms['bandwidth'][-1] > 40.0
    without = swung('hysteresis', 8.0, learning=False)[1]
    assert rms(run) < 0.06 * DEGREE < 0.2 * rms(without)


@pytest.mark.slow
def test_a_lag_is_learned_and_the_bandwidth_stays():
    law, run = swung('lag')
    fill, vent = law._learner.lag
    assert 0.04 < 0.5 * (fill + vent) < 0.07
    assert run.terms['bandwidth'][-1] < 30.0
    without = swung('lag', 8.0, learning=False)[1]
    # With other noise it is 0.04 to 0.08 degrees.
    assert rms(run) < 0.1 * DEGREE < 0.4 * rms(without)


def test_a_declared_lag_leaves_nothing_to_learn():
    law, run = swung('lag', 8.0, effects=LAG)
    assert law._learner.lag == (0.0, 0.0)
    assert np.max(np.abs(run.terms['learned'])) < 3.0 * ARMS
    assert rms(run) < 0.02 * DEGREE


@pytest.mark.slow
def test_friction_of_the_pivot_is_learned():
    law, run = swung('friction')
    assert law._learner._weights[:ELEMENTS].sum() == pytest.approx(0.15, abs=0.05)
    assert rms(run) < 0.9 * rms(swung('friction', 8.0, learning=False)[1])


@pytest.mark.slow
def test_of_all_at_once_enough_is_learned():
    _, run = swung('all')
    assert rms(run) < 0.2 * DEGREE
    assert np.max(np.abs(run.terms['learned'])) <= LearningTuning().most * ARMS
