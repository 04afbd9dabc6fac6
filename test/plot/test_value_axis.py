# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The vertical axis of signals as they are measured: what is inside of it, and what is not."""

import numpy as np
import pytest

from pam_ros.plot.panels import Curves, panels
from pam_ros.plot.topics import Key
from pam_ros.plot.value_axis import judged, value_axis

POSITION = Key('position', 'joint_states', 'pam')
T = np.arange(4000) / 200.0  # 20 s at 200 Hz
NOISE = 2e-5 * np.random.default_rng(1).standard_normal(T.size)  # m, of an encoder
MOVES = 0.05 + 0.01 * np.sin(2.0 * np.pi * 0.5 * T) + NOISE
RESTS = 0.05 + NOISE


def axis_of(*curves, start=0.0, end=20.0):
    """Return the axis of curves of several joints, or of one."""
    keys = [Key('position', 'joint_states', f'joint {i}') for i in range(len(curves))]
    samples = {key: (T, value) for key, value in zip(keys, curves, strict=True)}
    (panel,) = panels(judged(Curves(samples)), 'm', 20.0)
    return value_axis(panel.lines, start, end)


def contains(axis, value):
    return axis.low < value.min() <= value.max() < axis.high


@pytest.mark.parametrize('signal', [MOVES, RESTS], ids=['moves', 'rests'])
@pytest.mark.parametrize('length', [1, 2])
@pytest.mark.parametrize('to', [60.0, -60.0])
def test_a_spike_is_outside_and_counted(signal, length, to):
    value = signal.copy()
    value[1234 : 1234 + length] = to
    axis = axis_of(value)
    assert contains(axis, signal)
    assert axis.high - axis.low < 1.2 * np.ptp(signal)
    assert (axis.above, axis.below) == ((length, 0) if to > 0.0 else (0, length))


def test_a_step_is_inside():
    value = np.where(T < 12.0, RESTS, 60.0 + RESTS)
    axis = axis_of(value)
    assert contains(axis, value)
    assert axis[2:] == (0, 0)


@pytest.mark.parametrize('shape', ['rectangle', 'triangle', 'bell'])
def test_a_short_peak_of_ten_samples_is_inside(shape):
    k = np.arange(10)
    form = {
        'rectangle': np.ones(10),
        'triangle': 1.0 - np.abs(k - 4.5) / 5.5,
        'bell': np.exp(-0.5 * ((k - 4.5) / 2.0) ** 2),
    }[shape]
    value = RESTS.copy()
    value[2000:2010] += 60.0 * form
    axis = axis_of(value)
    assert contains(axis, value)
    assert axis[2:] == (0, 0)


def test_noise_and_a_constant_are_inside():
    for value in (RESTS, MOVES, np.full(T.size, 0.05), np.zeros(T.size)):
        axis = axis_of(value)
        assert contains(axis, value)
        assert axis[2:] == (0, 0)


def test_the_axis_of_a_constant_is_not_thinner_than_its_ticks_can_show():
    axis = axis_of(np.full(T.size, 0.05))
    assert axis.high - axis.low == pytest.approx(1.12 * 0.05 * 1e-4, rel=0.2)


def test_an_outlier_that_does_not_flatten_the_axis_is_inside():
    value = MOVES.copy()
    value[777] = MOVES.max() + 1.5 * np.ptp(MOVES)
    axis = axis_of(value)
    assert contains(axis, value)
    assert axis[2:] == (0, 0)


def test_a_spike_within_the_range_of_another_line_is_inside():
    value = RESTS.copy()
    value[777] = 0.3
    other = 0.2 + 0.2 * np.sin(T)
    assert axis_of(value).above == 1
    axis = axis_of(value, other)
    assert axis.above == 0
    assert contains(axis, np.append(value, other))


def test_a_signal_with_many_spikes_is_like_that():
    value = RESTS.copy()
    value[::20] = 60.0
    axis = axis_of(value)
    assert contains(axis, value)
    assert axis[2:] == (0, 0)


def test_only_what_is_seen_counts():
    value = MOVES.copy()
    value[1234] = 60.0  # at 6.17 s
    value[T >= 15.0] += 1.0
    axis = axis_of(value, end=6.0)
    assert axis.high < 0.07
    assert axis.above == 0
    assert axis_of(value, end=10.0).above == 1
    assert axis_of(value, start=16.0).low > 1.0
    assert axis_of(value, start=30.0, end=31.0) == (0.0, 1.0, 0, 0)


def test_a_command_acts_however_short_it_is():
    t = np.arange(100.0)
    value = np.zeros(100)
    value[50] = 3e5
    key = Key('pressure', 'pressure_command')
    (panel,) = panels(judged(Curves({key: (t, value)})), 'm', 100.0)
    axis = value_axis(panel.lines, 0.0, 100.0)
    assert axis.high > 3e5
    assert axis.above == 0
