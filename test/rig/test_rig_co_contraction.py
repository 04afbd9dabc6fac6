# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pressures for an effort and a stiffness, against searches over equations of their own."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import brentq

from pam_ros.errors import ParameterError, RangeError
from pam_ros.rig import statics
from pam_ros.rig.co_contraction import (
    co_contraction_pressures,
    joint_stiffness,
    joint_stiffness_range,
)
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.standard_joints import single_muscle_joint
from support import joints
from support.joint_models import BOTH_LONG, UNEQUAL, lever, pair, parallel

BAR = 1e5


def searched(angle, tau):
    """Return the range of stiffness by walking over the first muscle's pressure."""
    y1, y2 = joints.ends(angle, UNEQUAL)
    found = []
    for p1 in np.linspace(0.0, 6.0, 3001):
        wanted = UNEQUAL[0].force(p1, y1) - tau / joints.R
        low, high = UNEQUAL[1].force(0.0, y2), UNEQUAL[1].force(6.0, y2)
        if UNEQUAL[0].force(p1, y1) < 0.0 or not max(low, 0.0) <= wanted <= high:
            continue
        p2 = brentq(lambda p, f=wanted: UNEQUAL[1].force(p, y2) - f, 0.0, 6.0)
        k = UNEQUAL[0].stiffness(p1, y1) + UNEQUAL[1].stiffness(p2, y2)
        found.append(joints.R**2 * k)
    return min(found), max(found)


@pytest.mark.parametrize(('angle', 'tau'), [(0.0, None), (0.5, None), (-0.4, 2.0), (0.2, -5.0)])
def test_the_range_of_stiffness_is_all_that_can_be_had(angle, tau):
    effort = joints.gravity(angle) if tau is None else tau
    low, high = joint_stiffness_range(pair(), angle, tau)
    a_step = 0.002 * 0.01 * (high - low) + 0.02  # of the walk
    assert (low, high) == pytest.approx(searched(angle, effort), abs=a_step)
    assert high > 1.5 * low


@given(st.floats(-0.6, 0.8), st.floats(0.0, 1.0), st.floats(-8.0, 8.0))
def test_pressures_give_the_wanted_effort_and_stiffness(angle, share, tau):
    joint = pair()
    try:
        low, high = joint_stiffness_range(joint, angle, tau)
    except RangeError:
        assume(False)
    wanted = low + share * (high - low)
    p = co_contraction_pressures(joint, angle, wanted, tau)
    bar = np.array(p) / BAR
    assert joints.torque(bar, angle, UNEQUAL) == pytest.approx(tau, abs=1e-9)
    y, k = joints.ends(angle, UNEQUAL), 0.0
    for strand, pressure, each in zip(UNEQUAL, bar, y, strict=True):
        assert -1e-6 <= pressure <= 6.0 + 1e-6
        assert strand.force(pressure, each) >= -1e-6
        k += joints.R**2 * strand.stiffness(pressure, each)
    assert k == pytest.approx(wanted, rel=1e-9)


def test_pressures_for_an_angle_make_the_joint_rest_there():
    joint = pair()
    low, high = joint_stiffness_range(joint, 0.3)
    for k in (low, 0.5 * (low + high), high):
        assert equilibrium(joint, co_contraction_pressures(joint, 0.3, k)) == pytest.approx(
            0.3, abs=1e-9
        )


def test_two_unequal_muscles_side_by_side_can_choose_a_stiffness_too():
    joint = parallel(60.0)
    low, high = joint_stiffness_range(joint, 0.02)
    p = co_contraction_pressures(joint, 0.02, 0.5 * (low + high))
    assert equilibrium(joint, p) == pytest.approx(0.02, abs=1e-9)
    assert statics.stiffness(joint, p, 0.02) == pytest.approx(0.5 * (low + high))


def test_what_is_out_of_reach_is_refused_with_a_sentence():
    joint = pair()
    with pytest.raises(RangeError) as error:
        co_contraction_pressures(joint, 0.3, 500.0)
    low, high = joint_stiffness_range(joint, 0.3)
    assert str(error.value) == (
        f'a stiffness of 500 N m/rad at 0.3 rad is out of reach: {low:.6g} to {high:.6g} is '
        'possible there'
    )
    with pytest.raises(RangeError) as error:
        co_contraction_pressures(joint, 0.3, 20.0, 100.0)
    assert str(error.value) == (
        'an effort of 100 N m at 0.3 rad is out of reach: there are no pressures within p_min '
        'and p_max that give it without a muscle that pushes'
    )
    with pytest.raises(RangeError) as error:
        joint_stiffness_range(parallel(60.0, BOTH_LONG), 0.02)
    assert str(error.value) == (
        'an effort of 588.4 N at 0.02 m determines the stiffness: it cannot be chosen'
    )
    with pytest.raises(RangeError) as error:
        joint_stiffness_range(single_muscle_joint(), 0.02)
    assert str(error.value) == 'a stiffness can be chosen for two muscles: this joint has 1'


@pytest.mark.parametrize('angle', [-0.5, 0.0, 0.6])
def test_a_lever_chooses_its_stiffness_as_a_pair_does(angle):
    """The arms change with the angle, so that the forces themselves add to the stiffness."""
    joint, h = lever(), 1e-5
    low, high = joint_stiffness_range(joint, angle)
    assert high > 1.3 * low
    for wanted in (low, 0.5 * (low + high), high):
        bar = np.array(co_contraction_pressures(joint, angle, wanted)) / BAR
        tau = joints.lever_torque(bar, angle, UNEQUAL)
        assert tau == pytest.approx(joints.gravity(angle), abs=1e-9)
        ends = (joints.lever_torque(bar, angle + way, UNEQUAL) for way in (h, -h))
        assert (next(ends) - next(ends)) / (2.0 * h) == pytest.approx(-wanted, rel=1e-6)
        # By the effort that holds it, the angle is where it rests.
        assert equilibrium(joint, bar * BAR) == pytest.approx(angle, abs=1e-8)


@pytest.mark.parametrize(
    'call',
    [
        lambda s: joint_stiffness(pair(), 3e5, s),
        lambda s: joint_stiffness(pair(), 3e5, [0.1, s]),
        lambda s: joint_stiffness_range(pair(), s),
        lambda s: co_contraction_pressures(pair(), s, 60.0),
    ],
    ids=['stiffness', 'of several', 'range', 'pressures'],
)
def test_an_angle_in_degrees_is_refused(call):
    with pytest.raises(ParameterError, match=r'^s = 17 rad is not possible with this joint: give'):
        call(17.0)
