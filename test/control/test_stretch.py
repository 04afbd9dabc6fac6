# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The stretch of a coordinate in which something holds."""

import pytest

from pam_ros.control.stretch import stretch


@pytest.mark.parametrize(('low', 'high'), [(-0.3, 0.71), (-2.0, 0.71), (-0.3, 5.0), (-2.0, 5.0)])
def test_its_ends_are_found_between_the_places(low, high):
    found = stretch((-1.0, 2.0), lambda s: low <= s <= high)
    assert found == pytest.approx((max(low, -1.0), min(high, 2.0)), abs=1e-8)


def test_where_it_holds_nowhere_there_is_none():
    assert stretch((-1.0, 2.0), lambda s: False) is None
    assert stretch((2.0, -1.0), lambda s: True) is None
