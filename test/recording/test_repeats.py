# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Values that a slow sensor repeats count once; values that are equal for other reasons all do."""

import numpy as np
import pytest

from pam_ros.recording.repeats import without_repeats
from pam_ros.recording.series import Series

T = 0.01 * np.arange(4000)
NOISE = 2e-5 * np.random.default_rng(3).standard_normal(T.size)
# m; at rest in the middle
MOTION = np.where((T > 15.0) & (T < 20.0), 0.02, 0.02 + 0.01 * np.sin(2.0 * np.pi * 0.4 * T))


def read(value, t=T):
    notes = []
    return without_repeats(Series('position_mm', t, value), notes), notes


def sampled(rate, value):
    """Return what a sensor with this *rate* in Hz gives in each row: its last value."""
    taken = np.floor(T * rate + 1e-9) / rate
    return value[np.round(taken / 0.01).astype(int)]


@pytest.mark.parametrize('rate', [50.0, 20.0, 5.0])
def test_each_value_of_a_slow_sensor_counts_once_when_it_was_taken(rate):
    found, (note,) = read(sampled(rate, MOTION + NOISE))
    every = round(100.0 / rate)
    np.testing.assert_allclose(found.t, T[::every])
    np.testing.assert_array_equal(found.value, (MOTION + NOISE)[::every])
    assert note == (
        f'position_mm repeats its values: it was measured at about {rate:g} Hz, and each value '
        'counts once'
    )


def test_at_rest_without_noise_it_is_measured_as_often():
    found, _ = read(sampled(20.0, MOTION))
    at_rest = found.t[(found.t > 15.1) & (found.t < 19.9)]
    np.testing.assert_allclose(np.diff(at_rest), 0.05, atol=0.011)


def test_a_sensor_whose_rate_does_not_divide_that_of_the_rows():
    found, (note,) = read(sampled(37.0, MOTION + NOISE))
    assert 'about 37 Hz' in note
    assert np.all(np.diff(found.value) != 0.0)
    assert found.t.size == pytest.approx(37.0 * T[-1], rel=0.01)


@pytest.mark.parametrize(
    'value',
    [
        MOTION + NOISE,
        np.round(MOTION, 4),  # an encoder of 0.1 mm
        np.round(MOTION + NOISE, 4),
        np.where(np.arange(T.size) % 10 == 5, np.roll(MOTION, 1), MOTION) + NOISE.round(4),
        1e5 * np.repeat(np.arange(40.0), 100),  # levels of a set pressure
        np.repeat(np.random.default_rng(1).uniform(0.0, 6e5, 40), 100),
        np.full(T.size, 0.02),
    ],
)
def test_other_equal_values_are_kept(value):
    found, notes = read(value)
    assert found.t.size == T.size
    assert notes == []
