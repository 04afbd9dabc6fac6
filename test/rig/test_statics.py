# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints at rest against roots, differences and searches over equations of their own."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import brentq

from pam_ros.errors import RangeError
from pam_ros.rig import statics
from pam_ros.rig.rig import Rig
from support import joints, paper
from support.joint_models import BOTH_LONG, UNEQUAL, pair, parallel

PRESSURES = [(0.0, 0.0), (4.0, 3.0), (6.0, 1.0), (1.0, 6.0), (6.0, 6.0)]
BAR = 1e5


def net(angle, p, strands=UNEQUAL):
    return joints.torque(p, angle, strands) - joints.gravity(angle)


@pytest.mark.parametrize('strands', [BOTH_LONG, UNEQUAL])
@pytest.mark.parametrize('p', PRESSURES)
def test_a_pair_rests_where_torques_balance(strands, p):
    root = brentq(net, -2.0, 2.0, (p, strands), xtol=1e-14)
    assert statics.equilibrium(pair(strands), BAR * np.array(p)) == pytest.approx(root, abs=1e-12)


def test_it_comes_to_rest_there():
    rig = Rig([pair()])
    rig.command([4e5, 2e5])
    rig.advance(8000)
    assert rig.position[0] == pytest.approx(brentq(net, -2.0, 2.0, ((4.0, 2.0),)), abs=1e-9)
    assert rig.models[0].rest([4e5, 2e5]) == pytest.approx(rig.position[0], abs=1e-9)
    np.testing.assert_allclose(rig.joint_outputs()[0, 0], joints.gravity(rig.position[0]))


def test_two_muscles_hold_the_weight_together():
    model = parallel(50.0, offsets=(0.02, -0.01))
    one, two = UNEQUAL

    def left(s, p, q):
        return one.force(p, 0.008 + s) + two.force(q, -0.002 + s) - 50.0 * paper.G

    for p, q in PRESSURES:
        root = brentq(left, -0.05, 0.2, (p, q), xtol=1e-15)
        assert model.rest([p * BAR, q * BAR]) == pytest.approx(root, abs=1e-12)


@pytest.mark.parametrize('angle', [-0.5, 0.0, 0.7])
def test_effort_stiffness_and_weight_are_those_of_the_equations(angle):
    p, h = (4.0, 3.0), 1e-5
    model, pascal = pair(), (4e5, 3e5)
    assert statics.effort(model, pascal, angle) == pytest.approx(joints.torque(p, angle, UNEQUAL))
    assert statics.weight(model, angle) == pytest.approx(joints.gravity(angle), rel=1e-12)
    y, total = joints.ends(angle, UNEQUAL), 0.0
    for strand, pressure, each in zip(UNEQUAL, p, y, strict=True):
        total += joints.R**2 * strand.stiffness(pressure, each)
    assert statics.stiffness(model, pascal, angle) == pytest.approx(total, rel=1e-12)
    # What returns the joint to its equilibrium: both stiffnesses.
    slope = (net(angle + h, p) - net(angle - h, p)) / (2.0 * h)
    whole = statics.stiffness(model, pascal, angle) + statics.weight_stiffness(model, angle)
    assert whole == pytest.approx(-slope, rel=1e-6)


def test_angles_may_be_arrays():
    model, angles = pair(), np.linspace(-0.5, 0.5, 7)
    for function in (statics.effort, statics.stiffness):
        found = function(model, (4e5, 3e5), angles)
        np.testing.assert_allclose(found, [function(model, (4e5, 3e5), a) for a in angles])
    assert statics.weight(model, angles).shape == angles.shape


def test_a_muscles_push_counts_as_none_in_the_pull():
    model = pair()
    y1, y2 = joints.ends(0.6, UNEQUAL)
    forces = UNEQUAL[0].force(0.0, y1), UNEQUAL[1].force(3.0, y2)
    assert forces[0] < 0.0 < forces[1]
    assert statics.pull(model, (0.0, 3e5), 0.6) == pytest.approx(-joints.R * forces[1])


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
    low, high = statics.stiffness_range(pair(), angle, tau)
    a_step = 0.002 * 0.01 * (high - low) + 0.02  # of the walk
    assert (low, high) == pytest.approx(searched(angle, effort), abs=a_step)
    assert high > 1.5 * low


@given(st.floats(-0.6, 0.8), st.floats(0.0, 1.0), st.floats(-8.0, 8.0))
def test_pressures_give_the_wanted_effort_and_stiffness(angle, share, tau):
    model = pair()
    try:
        low, high = statics.stiffness_range(model, angle, tau)
    except RangeError:
        assume(False)
    wanted = low + share * (high - low)
    p = statics.pressures(model, angle, wanted, tau)
    bar = np.array(p) / BAR
    assert joints.torque(bar, angle, UNEQUAL) == pytest.approx(tau, abs=1e-9)
    y, k = joints.ends(angle, UNEQUAL), 0.0
    for strand, pressure, each in zip(UNEQUAL, bar, y, strict=True):
        assert -1e-6 <= pressure <= 6.0 + 1e-6
        assert strand.force(pressure, each) >= -1e-6
        k += joints.R**2 * strand.stiffness(pressure, each)
    assert k == pytest.approx(wanted, rel=1e-9)


def test_pressures_for_an_angle_make_the_joint_rest_there():
    model = pair()
    low, high = statics.stiffness_range(model, 0.3)
    for k in (low, 0.5 * (low + high), high):
        assert model.rest(statics.pressures(model, 0.3, k)) == pytest.approx(0.3, abs=1e-9)


def test_two_unequal_muscles_side_by_side_can_choose_a_stiffness_too():
    model = parallel(60.0)
    low, high = statics.stiffness_range(model, 0.02)
    p = statics.pressures(model, 0.02, 0.5 * (low + high))
    assert model.rest(p) == pytest.approx(0.02, abs=1e-9)
    assert statics.stiffness(model, p, 0.02) == pytest.approx(0.5 * (low + high))


def test_what_is_out_of_reach_is_refused_with_a_sentence():
    model = pair()
    with pytest.raises(RangeError) as error:
        statics.pressures(model, 0.3, 500.0)
    low, high = statics.stiffness_range(model, 0.3)
    assert str(error.value) == (
        f'a stiffness of 500 N m/rad at 0.3 rad is out of reach: {low:.6g} to {high:.6g} can be '
        'had there'
    )
    with pytest.raises(RangeError) as error:
        statics.pressures(model, 0.3, 20.0, 100.0)
    assert str(error.value) == (
        'an effort of 100 N m at 0.3 rad is out of reach: there are no pressures within p_min '
        'and p_max that give it and leave no muscle pushing'
    )
    with pytest.raises(RangeError) as error:
        statics.stiffness_range(parallel(60.0, BOTH_LONG), 0.02)
    assert str(error.value) == (
        'the muscles have one stiffness for 588.4 N at 0.02 m: there is none to choose'
    )


def test_a_load_that_stands_on_soft_muscles_falls_to_either_side():
    """Upside down, without pressure, the upright is unstable: the rest is beside it."""
    heavy = {'mass': 6.0, 'hanging_at': np.pi, 'contraction_1': 0.1, 'contraction_2': 0.1}
    model = pair(BOTH_LONG, **heavy)
    assert statics.stiffness(model, 0.0, 0.0) + statics.weight_stiffness(model, 0.0) < 0.0
    angle = model.rest(0.0)
    assert abs(angle) > 0.1
    assert statics.effort(model, 0.0, angle) == pytest.approx(statics.weight(model, angle))
    assert statics.stiffness(model, 0.0, angle) + statics.weight_stiffness(model, angle) > 0.0
    assert model.rest(6e5) == pytest.approx(0.0, abs=1e-12)  # filled, it stands


def test_the_span_is_where_both_muscles_have_permissible_lengths():
    """From -4 to 25 %: the first muscle limits one end, the second the other."""
    low, high = statics.span(pair())
    kappa = np.array([joints.ends(a, UNEQUAL) for a in (low, high)]) / [s.l0 for s in UNEQUAL]
    assert np.all(kappa > -0.04 - 1e-12)
    assert np.all(kappa < 0.25 + 1e-12)
    assert kappa[0, 1] == pytest.approx(0.25)
    assert kappa[1, 1] == pytest.approx(-0.04)
    assert statics.span(parallel(50.0, BOTH_LONG), 0.1, 0.9) == pytest.approx((-0.056, 0.38))
