# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Losses have their share and their length, and are the same for all controllers of a seed."""

import itertools

import numpy as np
import pytest

from pam_ros.bench.faults import NO_FAULTS, CommandFaults, MessageFaults, StateFaults, draw

RATE, COUNT = 500.0, 200_000


def runs_of(lost):
    """Return the lengths of all runs of True."""
    return [len(list(run)) for value, run in itertools.groupby(lost.tolist()) if value]


@pytest.mark.parametrize(
    ('loss', 'dropout', 'length'),
    [
        (0.1, 0.0, 1.0 / 0.9),
        (0.1, 0.05, 25.0),
        (0.5, 0.02, 10.0),
        (0.9, 0.004, 10.0),  # independent losses of this share last longer
    ],
)
def test_the_share_and_the_mean_length_of_losses(loss, dropout, length):
    for messages in (
        MessageFaults(states=StateFaults(loss, dropout)),
        MessageFaults(commands=CommandFaults(loss, dropout)),
    ):
        found = draw(messages, RATE, COUNT, 0)
        both = found.states_lost, found.commands_lost
        (lost,) = [one for one in both if one.any()]
        assert not lost[0]
        assert lost.mean() == pytest.approx(loss, rel=0.1)
        assert np.mean(runs_of(lost)) == pytest.approx(length, rel=0.1)


def test_one_fault_does_not_change_another_and_a_seed_changes_all():
    states, commands = StateFaults(0.1), CommandFaults(0.1, delay=0.008, jitter=0.004)
    alone = draw(MessageFaults(states), RATE, COUNT, 3)
    both = draw(MessageFaults(states, commands), RATE, COUNT, 3)
    other = draw(MessageFaults(states, commands), RATE, COUNT, 4)
    np.testing.assert_array_equal(alone.states_lost, both.states_lost)
    assert not (both.states_lost == both.commands_lost).all()
    for one, two in zip(both, other, strict=True):
        assert (one != two).any()
    assert both.delays.min() == pytest.approx(0.008, abs=1e-5)
    assert both.delays.max() == pytest.approx(0.012, abs=1e-5)
    assert both.delays.mean() == pytest.approx(0.010, abs=1e-5)


def test_without_faults_nothing_is_lost_or_late():
    assert not any(one.any() for one in draw(NO_FAULTS, RATE, 1000, 0))
