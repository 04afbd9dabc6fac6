# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The last seconds of curves, thinned as they come in."""

import numpy as np
import pytest

from pam_ros.plot.history import COLUMNS, JUDGED, MOST, History
from pam_ros.plot.topics import Key

FORCE = Key('force', 'force')


def filled(span, t, value):
    history = History(span)
    for one in zip(t.tolist(), value.tolist(), strict=True):
        history.add(FORCE, *one)
    return history


def test_few_samples_are_kept_as_they_are():
    t = np.arange(100) / 10.0
    history = filled(20.0, t, np.sin(t))
    found_t, found = history.curves(10.0).samples[FORCE]
    assert np.array_equal(found_t, t)
    assert np.array_equal(found, np.sin(t))


@pytest.mark.parametrize('rate', [50.0, 1000.0, 20_000.0])
def test_memory_is_bounded_and_no_peak_is_lost(rate):
    span = 5.0
    t = np.arange(int(3.0 * span * rate)) / rate
    value = np.sin(40.0 * t)
    peak = int((3.0 * span - 1.234) * rate)
    value[peak] = 7.0
    curves = filled(span, t, value).curves(t[-1])
    found_t, found = curves.samples[FORCE]
    assert found.size <= MOST * COLUMNS + JUDGED
    assert np.all(np.diff(found_t) > 0.0)
    assert found_t[np.argmax(found)] == t[peak]
    assert found.max() == 7.0
    assert t[-1] - span - 2.0 * max(span / COLUMNS, 1.0 / rate) <= found_t[0] <= t[-1] - span
    # Each of them is one of the samples, and the peak of one sample is an outlier.
    assert np.array_equal(value[np.searchsorted(t, found_t)], found)
    assert found_t[curves.is_outlier[FORCE]].tolist() == [t[peak]]


def test_a_slow_signal_that_ended_is_forgotten_but_for_its_last_sample():
    t = np.arange(1000.0)
    history = filled(20.0, t, np.sin(t))
    assert history.curves(1010.0).samples[FORCE][0].tolist() == list(range(989, 1000))
    assert history.curves(5000.0).samples[FORCE][0].tolist() == [999.0]


@pytest.mark.parametrize('length', [1, 6, 10])
def test_a_peak_is_no_outlier_however_long_the_axis_is(length):
    # A column has 600 ms, and the peak a few of them.
    t = np.arange(30_000) / 1000.0
    value = 1.0 + 1e-3 * np.random.default_rng(3).standard_normal(t.size)
    value[20_000 : 20_000 + length] = 50.0
    curves = filled(3600.0, t, value).curves(30.0)
    assert curves.samples[FORCE][1].max() == 50.0
    assert curves.is_outlier[FORCE].any() == (length == 1)


def test_a_command_that_goes_back_within_a_column_does_not_stay():
    history = filled(3600.0, np.array([0.0, 0.1, 0.2, 900.0]), np.array([1.0, 5.0, 1.0, 1.0]))
    for k in range(200):
        history.add(FORCE, 1000.0 + k, 1.0)
    found_t, found = history.curves(1500.0).samples[FORCE]
    assert found_t[:4].tolist() == [0.0, 0.1, 0.2, 900.0]
    assert found[:4].tolist() == [1.0, 5.0, 1.0, 1.0]


def test_a_sample_that_is_published_again_is_one():
    history = filled(2.0, np.array([0.0, 0.0, 0.0, 1.0]), np.array([3.0, 3.0, 3.0, 3.0]))
    assert history.curves(1.0).samples[FORCE][0].tolist() == [0.0, 1.0]


def test_the_last_sample_before_the_window_stays():
    history = filled(2.0, np.array([1.0, 5.0]), np.array([3.0, 4.0]))
    found_t, found = history.curves(100.0).samples[FORCE]
    assert (found_t[-1], found[-1]) == (5.0, 4.0)


def test_values_that_are_not_finite_are_left_out():
    history = filled(2.0, np.arange(4.0), np.array([np.nan, np.inf, -np.inf, 1.0]))
    assert history.curves(3.0).samples[FORCE][1].tolist() == [1.0]


def test_names_of_muscles_stay_and_samples_can_be_forgotten():
    history = filled(2.0, np.arange(3.0), np.arange(3.0))
    history.name_muscles(('flexor', 'extensor'))
    history.name_muscles(())
    history.clear()
    found = history.curves(3.0)
    assert found.muscles == ('flexor', 'extensor')
    assert found.samples == {}
