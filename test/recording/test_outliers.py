# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Samples that jump away from their neighbours and back are found; real events are not."""

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.assemble import assemble
from pam_ros.recording.outliers import outliers, without_outliers
from pam_ros.recording.series import Series

T = 0.01 * np.arange(3000)
RNG = np.random.default_rng(8)
NOISE = 2e-5 * RNG.standard_normal(T.size)  # m
MOTION = 0.05 + 0.02 * np.sin(2.0 * np.pi * 0.7 * T) + 0.01 * np.sin(2.0 * np.pi * 0.13 * T)
POSITION = MOTION + NOISE


def with_glitches(at, size):
    value = POSITION.copy()
    value[at] += size
    return value


@pytest.mark.parametrize(
    ('size', 'length'), [(0.03, 1), (-0.03, 1), (4e-3, 1), (0.03, 2), (0.03, 5), (-0.03, 5)]
)
def test_a_glitch_is_found_and_nothing_else(size, length):
    at = 1234 + np.arange(length)
    np.testing.assert_array_equal(np.flatnonzero(outliers(with_glitches(at, size))), at)


def test_one_in_a_hundred_is_found():
    at = np.arange(37, 2990, 100)
    found = outliers(
        with_glitches(at, RNG.uniform(4e-3, 0.05, at.size) * RNG.choice([-1, 1], at.size))
    )
    np.testing.assert_array_equal(np.flatnonzero(found), at)


@pytest.mark.parametrize('dropout', [0.0, -1.0, 99.0])
def test_dropouts_are_found_in_a_signal_without_noise(dropout):
    value = np.round(MOTION, 4)  # an encoder
    value[[500, 501, 1700]] = dropout
    assert np.flatnonzero(outliers(value)).tolist() == [500, 501, 1700]


def ringing(t):
    """Return what a light joint does after its load is dropped: 8 Hz, which decays."""
    return np.where(t > 0.0, 0.02 * (1.0 - np.exp(-6.0 * t) * np.cos(50.0 * t)), 0.0)


@pytest.mark.parametrize(
    'value',
    [
        POSITION,
        np.round(POSITION, 4),
        np.round(MOTION, 3),
        np.clip(MOTION, 0.04, 0.06) + NOISE,  # stops
        0.01 + ringing(T - 12.0) + NOISE,
        0.01 + np.where(T > 12.0, 0.02, 0.0) + NOISE,  # a step
        1e5 * np.repeat(RNG.uniform(0.5, 5.0, 60), 50) + 200.0 * RNG.standard_normal(T.size),
        0.02 * np.abs(np.sin(2.0 * np.pi * 1.1 * T)) + NOISE,  # impacts
        np.full(T.size, 3.0),
    ],
)
def test_real_events_are_none(value):
    assert not outliers(value).any()


def test_they_are_left_out_counted_and_named_by_their_times():
    one = Series('position_mm', T, with_glitches([500, 900], 0.03))
    notes = []
    found = without_outliers(one, notes)
    np.testing.assert_array_equal(found.t, np.delete(T, [500, 900]))
    np.testing.assert_array_equal(found.value, np.delete(POSITION, [500, 900]))
    assert notes == ['2 of 3000 samples of position_mm are outliers and are left out, at 5, 9 s']
    without_outliers(Series('x', T, with_glitches([500], 0.03)), notes)
    assert notes[1] == '1 of 3000 samples of x is an outlier and is left out, at 5 s'


SPOILED = np.arange(20, 2980, 30)


@pytest.mark.parametrize('unit', ['position_m', 'contraction_fraction'])
def test_too_many_of_a_signal_that_is_needed_are_refused(unit):
    quantity = unit.rpartition('_')[0]
    series = {
        'pressure_command': Series('u', T, 1e5 * np.sin(T) + 2e5),
        quantity: Series(unit, T, with_glitches(SPOILED, 0.03)),
    }
    with pytest.raises(RecordingError, match=rf'log\.csv: 99 of 3000 samples of {unit} jump'):
        assemble('log.csv', series, [], l0=0.4)


def test_of_another_signal_they_leave_it_out_with_a_note():
    series = {
        'pressure_command': Series('u', T, 1e5 * np.sin(T) + 2e5),
        'position': Series('y', T, POSITION),
        'velocity': Series('v', T, with_glitches(SPOILED, 0.03)),
        'pressure': Series('p', T, 1e7 * with_glitches(SPOILED, 0.03)),
    }
    found = assemble('log.csv', series, [])
    assert (found.velocity, found.pressure) == (None, None)
    assert [note.endswith('it is not used') for note in found.warnings] == [True, True]
    np.testing.assert_array_equal(found.position, POSITION)
