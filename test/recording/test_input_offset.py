# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings whose input acts earlier than it was stamped."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.recording.input_offset import with_earlier_input
from pam_ros.recording.recording import Recording

T = np.arange(101) / 100
OFFSET = 0.035


def recording(**changes):
    """Return a recording whose outputs at t are those that an input causes at t + OFFSET."""
    true = T + OFFSET
    command = np.floor(10.0 * T)
    given = Recording('a', T, T, command, np.sin(true), velocity=np.cos(true))
    return replace(given, **changes)


def test_commands_move_and_samples_without_a_known_command_are_left_out():
    moved = with_earlier_input(recording(), OFFSET)
    np.testing.assert_allclose(moved.t, T[T + OFFSET <= 1.0])
    np.testing.assert_allclose(moved.position, np.sin(moved.t + OFFSET))
    # The command at 0.1 s acts at 0.065 s, and the first one is in force at the first sample.
    assert moved.command_t[0] <= 0.0 < moved.command_t[1]
    held = moved.command[np.searchsorted(moved.command_t, [0.0, 0.064, 0.066], 'right') - 1]
    np.testing.assert_allclose(held, [0.0, 0.0, 1.0])


def test_commands_after_the_last_sample_are_known():
    later = np.append(T, 1.2)
    given = recording(command_t=later, command=np.zeros(later.size))
    assert with_earlier_input(given, OFFSET).t.size == T.size


@pytest.mark.parametrize('kind', ['free', 'held'])
def test_a_measured_pressure_moves_if_it_is_the_input(kind):
    changes = {'pressure': T**2, 'kind': kind}
    if kind == 'free':
        changes |= {'command_t': None, 'command': None}
    moved = with_earlier_input(recording(**changes), OFFSET)
    np.testing.assert_allclose(moved.pressure, (moved.t + OFFSET) ** 2, atol=1e-4)
    np.testing.assert_allclose(moved.position, np.sin(moved.t + OFFSET))
    assert moved.t[-1] == pytest.approx(0.96)


@pytest.mark.parametrize('has_commands', [True, False])
def test_before_a_gap_only_known_commands_act(has_commands):
    there = (T <= 0.4) | (T >= 0.7)
    given = recording(t=T[there], position=T[there], velocity=None, gaps=((0.4, 0.7),))
    if not has_commands:
        given = replace(given, command_t=T[there], command=np.zeros(there.sum()))
    moved = with_earlier_input(given, OFFSET)
    last = 0.4 if has_commands else 0.36
    np.testing.assert_allclose(moved.gaps, [(last, 0.7)])
    assert not ((moved.t > last + 1e-9) & (moved.t < 0.7)).any()
