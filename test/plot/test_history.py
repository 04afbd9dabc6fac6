# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The last seconds of curves, thinned as they come in."""

import numpy as np
import pytest

from pam_ros.plot.history import COLUMNS, History
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
    found_t, found = filled(span, t, value).curves(t[-1]).samples[FORCE]
    assert found.size <= 2 * COLUMNS + 4
    assert np.all(np.diff(found_t) > 0.0)
    assert found_t[np.argmax(found)] == t[peak]
    assert found.max() == 7.0
    assert t[-1] - span - 2.0 * max(span / COLUMNS, 1.0 / rate) <= found_t[0] <= t[-1] - span
    # Each of them is one of the samples.
    assert np.array_equal(value[np.searchsorted(t, found_t)], found)


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
