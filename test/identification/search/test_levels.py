# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a report says of isometric recordings at one length that lie apart."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.fit.run_levels import repeats
from pam_ros.identification.fit.unknowns import RunLevel
from pam_ros.identification.search.levels import apart
from pam_ros.recording.recording import Recording
from support import bench_truth
from support.searches import at_nominal, setting_of


def at(kappa, name='held'):
    t = np.arange(400) / 100.0
    position = np.full(t.size, kappa * bench_truth.nominal().muscle.l0)
    return Recording(name, t, None, None, position, None, 100.0 + t, 1e5 + t, 'held')


@pytest.fixture(scope='module')
def known():
    """Return the configured model over two repeats at 5 %, one at 10 % and a third at 5 %."""
    recordings = [at(kappa) for kappa in (0.05, 0.05, 0.1, 0.05)]
    problem = setting_of(recordings, None).problem
    levels = {0: 6.0, 1: -2.5}
    u = [
        one.coordinate(levels[one.of.run]) if isinstance(one.of, RunLevel) else 0.0
        for one in problem.unknowns
    ]
    return replace(at_nominal(problem), u=np.array(u))


def test_repeats_are_the_runs_at_one_length_in_their_order(known):
    l0 = bench_truth.nominal().muscle.l0
    assert repeats(known.problem.segments, l0) == [[0, 1, 3], [2]]


def test_lengths_whose_recordings_lie_apart_are_listed_with_their_levels(known):
    (text,) = apart(known, noise=2.0)
    assert text == (
        'the recordings at 5 % contraction differ by 8.5 N, more than the noise '
        '(+6.0, -2.5, +0.0 N, in their order): the model describes the last one'
    )


def test_differences_within_the_noise_are_not_worth_a_sentence(known):
    assert apart(known, noise=9.0) == ()
