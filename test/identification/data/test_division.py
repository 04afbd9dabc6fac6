# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is fitted and what decides contain both directions of the input, and its range."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.data.division import (
    BLOCKS,
    CHOOSE,
    FIT,
    JUDGE,
    LEFT_OUT,
    contain_all,
    divide,
    divide_in_time,
)
from pam_ros.recording.recording import Recording

T = np.arange(2000) / 100.0
RISE = np.linspace(0.0, 1.0, T.size)
CYCLE = 1.0 - np.abs(1.0 - 2.0 * RISE)
STEPS = np.repeat(np.random.default_rng(0).permutation(20) / 20.0, T.size // 20)


def recorded(*commands, **changes):
    """Return a free recording under *commands* between 0 and 1, for each muscle."""
    values = 1e5 + 3e5 * np.stack(commands, axis=1)
    muscles = tuple(f'm{k}' for k in range(len(commands))) if len(commands) > 1 else ()
    command = values if muscles else values[:, 0]
    free = Recording('r', T, T, command, np.zeros(T.size), muscles=muscles)
    return replace(free, **changes)


def divided(recording, fit=0.55, choose=0.75):
    return divide(recording, T[0], T[-1], fit, choose)


def is_in_turn(recording, **shares):
    found = divided(recording, **shares)
    return found.roles.size > 3


@pytest.mark.parametrize(
    ('command', 'expected'),
    [
        (STEPS, False),
        (np.sin(8.0 * T), False),
        (CYCLE, True),
        (1.0 - CYCLE, True),
        (RISE, True),  # one direction, of which *choose* would see a fifth of the range
        (CYCLE + 0.04 * np.sin(60.0 * T), True),  # small changes are no directions
        (np.where(T < 12.0, 0.0, 1.0), False),  # a single step is in one block as well
    ],
)
def test_parts_are_blocks_in_turn_where_the_time_does_not_contain_all(command, expected):
    assert is_in_turn(recorded(command)) is expected


def test_each_part_of_a_slow_cycle_sees_it_rise_and_fall_and_the_end_judges():
    roles = divided(recorded(CYCLE)).at(T)
    np.testing.assert_array_equal(roles == JUDGE, 0.75 * T[-1] <= T)
    assert np.mean(roles == CHOOSE) == pytest.approx(0.19, abs=0.02)
    for role in (FIT, CHOOSE):
        change = np.diff(CYCLE)[roles[1:] == role]
        assert min(np.sum(change > 0.0), np.sum(change < 0.0)) >= 0.04 * T.size
        assert np.ptp(CYCLE[roles == role]) > 0.6


def test_with_other_recordings_that_judge_all_of_it_is_in_turn():
    found = divided(recorded(CYCLE), fit=0.55 / 0.75, choose=1.0)
    assert set(found.at(T)) == {FIT, CHOOSE}
    assert found.ends.size == BLOCKS


def test_every_muscle_counts():
    assert is_in_turn(recorded(STEPS, CYCLE))
    assert not is_in_turn(recorded(STEPS, 0.5 * np.ones(T.size)))


def test_without_commands_the_measured_pressure_decides():
    noisy = CYCLE + 0.01 * np.random.default_rng(1).standard_normal(T.size)
    plain = recorded(CYCLE, command_t=None, command=None, pressure=1e5 + 3e5 * noisy)
    np.testing.assert_array_equal(divided(plain).roles, divided(recorded(CYCLE)).roles)


def test_a_long_recording_is_judged_by_some_of_its_samples():
    t = np.linspace(0.0, T[-1], 50_000)
    long = Recording('r', t, t, 1e5 * np.interp(t, T, CYCLE), np.zeros(t.size))
    assert not contain_all(divide_in_time(T[0], T[-1], 0.55, 0.75), long)
    assert is_in_turn(long)


@pytest.mark.parametrize('start', [3.0, 8.0, 10.25])
@pytest.mark.parametrize('last', [5.0, 1.0])
def test_times_without_a_role_are_in_no_part(start, last):
    whole = divide_in_time(T[0], T[-1], 0.5, 0.75)
    inside = (start <= T) & (start + last > T)
    roles = whole.without(start, start + last).at(T)
    np.testing.assert_array_equal(roles, np.where(inside, LEFT_OUT, whole.at(T)))
