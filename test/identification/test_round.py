# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A round of candidates on top of what was found before."""

import pytest

from pam_ros.identification.candidate import fitted
from pam_ros.identification.round import try_effects
from pam_ros.identification.solve import solve
from support.rounds import KNOWN, with_effects

pytestmark = pytest.mark.needs_numba


def test_no_candidate_has_the_credit_for_what_its_parent_missed(setting):
    right = with_effects(setting, 'viscous_friction', 'pressure_lag')
    assert right.held_error < 1.2 * setting.noise.sigma
    u = right.solution.u.copy()
    u[:3] += 1.0
    astray = fitted(right.effects, solve(right.solution.problem, u, 0))
    assert astray.held_error > 5.0 * right.held_error
    parent, tried = try_effects(astray, [KNOWN['creep'], KNOWN['end_stop']], setting)
    assert parent.effects == right.effects
    assert parent.held_error < 1.1 * right.held_error
    for one in tried:
        assert one.parents == right.effects
        assert one.evidence.gain < 0.05
