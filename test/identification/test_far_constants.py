# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Constants that no specimen has are named after an identification."""

import pytest

from pam_ros.identification.identify import identify
from support import bench_truth


@pytest.mark.needs_numba
@pytest.mark.parametrize(('share', 'is_far'), [(0.3, True), (0.05, False)])
def test_constants_far_from_the_nominal_ones_are_named(share, is_far):
    off = (0.0, 0.0, 0.0, 0.0, share, 0.0)
    found = identify(bench_truth.nominal(off=off), bench_truth.free(duration=15.0))
    assert found.verdict == 'parameters_wrong'
    warnings = [text for text in found.warnings if 'far from the nominal ones' in text]
    assert len(warnings) == is_far
    if is_far:
        assert 'a5 77 %' in warnings[0]
