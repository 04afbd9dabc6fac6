# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Thresholds of Maxwell slip, and its elements against the closed form of their mean."""

import numpy as np
import pytest

from pam_ros.compiled import plain
from pam_ros.effects.maxwell_slip import ELEMENTS, MOST, slipped, strains, threshold


def thresholds(onset, ratio):
    return np.array([plain(threshold)(n, onset, ratio) for n in range(ELEMENTS)])


def test_gaps_are_equal_with_ratio_1_and_grow_by_the_same_factor_with_others():
    np.testing.assert_allclose(thresholds(0.0, 1.0), (np.arange(ELEMENTS) + 0.5) / ELEMENTS)
    gaps = np.diff(thresholds(0.2, 50.0))
    np.testing.assert_allclose(gaps[1:] / gaps[:-1], 50.0 ** (1.0 / ELEMENTS), rtol=1e-12)


@pytest.mark.parametrize('onset', [0.01, 0.05, 0.4])
def test_ratio_one_over_onset_makes_the_thresholds_a_geometric_series(onset):
    found = thresholds(onset, 1.0 / onset)
    np.testing.assert_allclose(found[1:] / found[:-1], onset ** (-1.0 / ELEMENTS), rtol=1e-12)


def test_the_ratio_has_no_jump_at_equal_gaps():
    np.testing.assert_allclose(thresholds(0.1, 1.0 + 1e-12), thresholds(0.1, 1.0), rtol=1e-11)


@pytest.mark.parametrize(
    ('onset', 'ratio'), [(0.0, 1.0), (0.0, 1.0 + 1e-9), (0.0, MOST), (1.0, 1.0), (0.05, 20.0)]
)
@pytest.mark.parametrize('way', [1e-4, 0.3, 0.9, 5.0, -0.4])
def test_the_first_loading_is_the_mean_of_elements_that_stick_or_slip(onset, ratio, way):
    width, after = 0.02, np.zeros(ELEMENTS)
    found = slipped(way * width, width, onset, ratio, np.zeros(ELEMENTS), 0, after)
    expected = np.mean(np.clip(way / thresholds(onset, ratio), -1.0, 1.0))
    assert found == pytest.approx(expected, rel=1e-12)
    size = width * thresholds(onset, ratio)
    np.testing.assert_allclose(after, np.clip(way * width, -size, size), rtol=1e-12)


def test_strains_of_a_share_are_that_share_of_the_mean():
    at = np.array(strains(-0.4, 0.02, 0.1, 5.0))
    assert slipped(0.0, 0.02, 0.1, 5.0, at, 0, np.zeros(ELEMENTS)) == pytest.approx(-0.4)
