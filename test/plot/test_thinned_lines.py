# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Lines thinned to the resolution of a plot."""

import numpy as np

from pam_ros.plot.panels import Curves, panels
from pam_ros.plot.thinning import is_outlier, thinned
from pam_ros.plot.topics import Key
from pam_ros.plot.value_axis import judged

FORCE, COMMAND = Key('force', 'force'), Key('pressure', 'pressure_command')
T = np.arange(100_000) / 500.0  # 200 s


def line_of(key, t, value, start=0.0, end=200.0, columns=1000):
    (panel,) = panels(judged(Curves({key: (t, value)})), 'm', end)
    (line,) = thinned(panel, start, end, columns).lines
    return line


def test_peaks_stay_at_their_times():
    value = np.sin(T)
    value[54_321] = 5.0
    line = line_of(FORCE, T, value)
    assert 1000 < line.t.size <= 2001
    assert line.t[np.nanargmax(line.value)] == T[54_321]
    assert line.t[is_outlier(line)].tolist() == [T[54_321]]
    # Each of them is one of the samples, and the least of each column is among them.
    assert np.array_equal(value[np.searchsorted(T, line.t)], line.value)
    column = np.floor(T / 200.0 * 1000)
    lows = np.minimum.reduceat(value, np.flatnonzero(np.diff(column, prepend=-1.0)))
    assert np.isin(lows, line.value).all()


def test_an_outlier_does_not_hide_the_greatest_value_of_its_column():
    value = np.sin(20.0 * T)
    column = slice(500, 1000)  # of 1 s
    greatest = value[column].max()
    value[700] = 99.0
    line = line_of(FORCE, T, value, columns=200)
    assert {greatest, 99.0} <= set(line.value[(line.t >= 1.0) & (line.t < 2.0)])


def test_gaps_stay_and_a_part_has_one_sample_beyond_each_end():
    t = np.concatenate([T[:50_000], T[60_000:]])
    line = line_of(FORCE, t, np.sin(t), 50.0, 150.0)
    gap = np.isnan(line.value)
    assert line.t[gap].tolist() == [120.0]
    assert line.t[[0, -1]].tolist() == [49.998, 150.002]
    assert not ((line.t > 100.0) & (line.t < 120.0)).any()


def test_few_samples_stay_as_they_are():
    t = T[:900]
    line = line_of(FORCE, t, np.sin(t))
    assert np.array_equal(line.t, t)


def test_a_command_that_ends_where_it_began_does_not_stay_where_it_was():
    value = np.where(T < 100.0, 1e5, 2e5)
    value[49_990:50_000] = 3e5
    value[99_998] = 3e5
    line = line_of(COMMAND, T, value)
    at = np.searchsorted(line.t, [99.9, 101.0, 199.9999], side='right') - 1
    assert line.value[at].tolist() == [1e5, 2e5, 2e5]
