# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Loops that a dead time, which nobody configured, makes unstable come to rest all the same."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.sliding_mode import SlidingMode
from support.closed_loop import nominal
from support.kinds import EACH_KIND, ONE, PAIR, rms
from support.marks import at_release
from truth.effects import effect

pytestmark = pytest.mark.needs_numba


def law_of(kind, **gains):
    joint = kind.nominal()
    return SlidingMode(joint, Gains.for_joint(joint, **gains))


def largest(kind, run, after, seconds):
    """Return the largest error in units of the kind, from *after* on for some *seconds*."""
    chosen = (run.t > after) & (run.t <= after + seconds)
    return np.max(np.abs(run.error[chosen])) / kind.unit


@EACH_KIND
def test_a_step_comes_to_rest(kind):
    law = law_of(kind)
    run = kind.close(law, kind.truth('dead time', seed=3), kind.step, 8.0)
    assert law.terms.feedback < 0.6
    assert largest(kind, run, 6.0, 2.0) < 0.02


@pytest.mark.slow
@EACH_KIND
def test_a_sine_is_followed(kind):
    law = law_of(kind)
    run = kind.close(law, kind.truth('dead time', seed=3), kind.swing, 12.0)
    amplitude = np.max(np.abs(run.target)) / kind.unit
    assert rms(kind, run) < 0.15 * amplitude


@pytest.mark.parametrize('mass', [5.0, 40.0])
def test_light_and_heavy_loads_come_to_rest(mass):
    law = SlidingMode(nominal(mass=mass))
    run = ONE.close(law, ONE.truth('dead time', mass=mass, seed=3), ONE.step, 10.0)
    assert largest(ONE, run, 8.0, 2.0) < 0.02


@pytest.mark.slow
def test_a_lightly_damped_load_comes_to_rest():
    """With a low share, the level of a disturbance makes slow swings grow."""
    law = SlidingMode(nominal(mass=27.0))
    plant = ONE.truth('dead time', mass=27.0, zeta=0.09, p0=230e3, seed=6)
    run = ONE.close(law, plant, ONE.step, 14.0)
    assert largest(ONE, run, 4.0, 10.0) < 8.0
    assert largest(ONE, run, 12.0, 2.0) < 0.05


@pytest.mark.slow
def test_a_push_that_makes_the_loop_oscillate_is_overcome():
    """At rest the loop is slow enough; the level of a disturbance makes it unstable."""
    law = law_of(ONE)
    late = (effect('dead_time', dead_time_s=0.06),)
    push = {'push': lambda t: 8.0 * math.sin(2.0 * math.pi * t) if 6.0 < t < 10.0 else 0.0}
    run = ONE.close(law, ONE.truth(late, seed=3), ONE.step, 14.0, **push)
    assert largest(ONE, run, 5.0, 1.0) < 0.02
    assert largest(ONE, run, 13.0, 1.0) < 0.05


@pytest.mark.slow
@pytest.mark.parametrize(
    'plant',
    ['friction', 'all', *map(at_release, ('nominal', 'payload', 'hysteresis', 'lag'))],
)
@EACH_KIND
def test_other_unconfigured_effects_hardly_lower_the_gains(kind, plant):
    for target in (kind.step, kind.swing):
        law = law_of(kind)
        kind.close(law, kind.truth(plant, seed=3), target, 8.0)
        # A lag is a delay, too: after a step, the pair rings with it.
        assert law.terms.feedback >= (0.5 if plant in ('lag', 'all') else 1.0)


def test_the_share_is_kept_at_a_start_but_not_with_other_gains():
    law = law_of(PAIR)
    PAIR.close(law, PAIR.truth('dead time', seed=3), PAIR.step, 3.0)
    share = law._estimates.reduction.share
    assert share < 1.0
    law.start(0.0)
    assert law._estimates.reduction.share == share
    law.set_gains(replace(law.gains, bandwidth=0.9 * law.gains.bandwidth))
    assert law._estimates.reduction.share == 1.0
