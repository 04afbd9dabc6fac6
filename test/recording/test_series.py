# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One signal on its own stamps: order, doubles, holes."""

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.series import Series, refuse_backwards


def series(t):
    t = np.asarray(t, float)
    return Series('pos', t, np.arange(t.size, dtype=float))


def test_time_that_goes_backwards_is_refused_with_the_place():
    with pytest.raises(
        RecordingError, match=r'log goes backwards: 0.1 s after 0.2 s, at sample 3'
    ):
        refuse_backwards(np.array([0.0, 0.2, 0.1, 0.3]), 'log')
    refuse_backwards(np.array([0.0, 0.1, 0.1, 0.2]), 'log')


def test_of_two_samples_at_one_time_the_last_is_kept():
    t = np.arange(1000) * 0.01
    t[500] = t[499]
    one = series(t)
    assert one.shared == 1
    assert not one.is_coarse
    assert one.ascending().t.size == 999
    assert one.ascending().value[499] == 500.0
    assert series(np.repeat(np.arange(500.0), 2)).is_coarse


def test_a_sample_that_is_repeated_with_the_same_value_is_one_sample():
    t, value = np.array([0.0, 0.0, 0.0, 1.0, 1.0]), np.array([5.0, 5.0, 6.0, 7.0, 7.0])
    assert Series('pos', t, value).shared == 1
    pairs = np.column_stack([value, [1.0, 2.0, 2.0, 3.0, 3.0]])
    assert Series('pressures', t, pairs).shared == 2
    assert Series('pos', t[:1], value[:1]).shared == 0
    assert not Series('pos', np.zeros(100), np.ones(100)).is_coarse


@pytest.mark.parametrize(('period', 'limit'), [(1e-3, 0.05), (0.02, 0.2)])
def test_a_gap_is_ten_periods_and_fifty_milliseconds(period, limit):
    t = np.arange(1000) * period
    t[400:] += limit - 1.1 * period
    assert series(t).holes() == []
    t[400:] += 0.2 * period
    assert series(t).holes() == [(pytest.approx(399 * period), pytest.approx(t[400]))]


def test_jitter_makes_no_gap():
    rng = np.random.default_rng(1)
    t = np.sort(np.arange(2000) * 1e-3 + rng.uniform(0.0, 4e-3, 2000))
    assert series(t).holes() == []


def test_single_values_may_be_missing():
    t = np.arange(1000) * 0.01
    value = np.sin(t)
    value[[5, 77, 78, 500]] = np.nan
    one = Series.taken('log', 'pos', t, value)
    assert one.t.size == 996
    assert np.isfinite(one.value).all()


def test_a_slower_column_is_no_stretch_of_missing_values():
    t = np.arange(10_000) * 0.001
    value = np.full(t.size, np.nan)
    value[::100] = 1.0
    assert Series.taken('log', 'p', t, value).t.size == 100


@pytest.mark.parametrize('missing', [slice(300, 340), slice(0, 120), slice(880, 1000)])
def test_a_stretch_without_values_is_refused(missing):
    t = np.arange(1000) * 0.01
    value = np.ones(t.size)
    value[missing] = np.nan
    with pytest.raises(RecordingError, match=r'log: pos has no values from .* s to .* s'):
        Series.taken('log', 'pos', t, value)


def test_a_column_may_begin_a_little_later():
    t = np.arange(1000) * 0.01
    value = np.ones(t.size)
    value[:80] = np.nan
    assert Series.taken('log', 'pos', t, value).t[0] == pytest.approx(0.8)


def test_infinite_values_are_refused():
    with pytest.raises(RecordingError, match='log: pos is infinite at 2 s'):
        Series.taken('log', 'pos', np.arange(4.0), np.array([0.0, 1.0, np.inf, np.nan]))
