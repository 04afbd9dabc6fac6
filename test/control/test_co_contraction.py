# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The stiffness that is set, and the way to it."""

import numpy as np
import pytest

from pam_ros.control.co_contraction import RISE, CoContraction, StiffnessReference
from pam_ros.errors import ParameterError, RangeError
from pam_ros.rig.standard_joints import single_muscle_joint
from support.closed_loop import shared
from support.pair_loop import nominal

SHARING = shared(nominal())
DT = 2e-3


def test_unless_it_is_set_it_is_in_the_middle_of_what_can_be_had():
    assert CoContraction().wanted(SHARING) == pytest.approx(0.5 * sum(SHARING.stiffness_range(0)))
    assert CoContraction(30.0).wanted(SHARING) == 30.0


def test_where_the_effort_settles_the_stiffness_none_is_wanted():
    assert CoContraction(30.0).wanted(shared(single_muscle_joint())) == 0.0


def test_a_stiffness_that_cannot_be_reached_is_refused():
    with pytest.raises(RangeError, match='co-contraction 90 N m/rad is out of reach'):
        CoContraction(90.0).wanted(SHARING)
    with pytest.raises(ParameterError, match='co_contraction_rate'):
        CoContraction(co_contraction_rate=0.0)


def test_another_is_approached_at_the_rate_and_without_a_jump():
    source = StiffnessReference(20.0, 100.0)
    source.start(20.0)
    source.set_goal(40.0)
    way = np.array([source.follow(DT) for _ in range(300)])
    slope = np.diff(way, prepend=20.0) / DT
    assert np.max(slope) == pytest.approx(100.0, rel=1e-6)
    assert np.min(slope) >= -1e-9
    assert np.max(np.abs(np.diff(slope, prepend=0.0))) / DT <= 1.001 * 100.0 / RISE
    # Two ramps of jerk and the way at the rate between them.
    assert np.argmax(way >= 40.0 - 1e-9) * DT == pytest.approx(20.0 / 100.0 + 2 * RISE, abs=0.01)
    assert way[-1] == 40.0


def test_a_new_goal_during_the_motion_makes_no_jump():
    source = StiffnessReference(20.0, 100.0)
    source.start(30.0)
    before = source.follow(DT)
    for n in range(200):
        if n % 7 == 0:
            source.set_goal(20.0 + n % 3)
        now = source.follow(DT)
        assert abs(now - before) <= 1.01 * 100.0 * DT
        before = now
