# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How muscles share an effort: the reach, and pressures for torque and stiffness."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.control.allocation import OneSide
from pam_ros.control.limits import Limits
from pam_ros.control.pressure_path import PressurePath
from pam_ros.effects import PressureLag, Slack
from pam_ros.errors import ParameterError, RangeError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import co_contraction, statics
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.transmissions import Lever, Pulley, Straight
from support.bench import cart, rest
from support.closed_loop import shared
from support.joint_models import pair

# One side ----------------------------------------------------------------------------------------


def test_the_reach_is_that_of_the_muscles_curve():
    joint = single_muscle_joint(Muscle(), Mass(mass=20.0))
    weight = float(statics.weight(joint, 0.0))
    low, high = shared(joint).reach
    assert low == pytest.approx(rest(0.02 * 600e3, weight), abs=1e-6)
    assert high == pytest.approx(rest(0.98 * 600e3, weight), abs=1e-6)
    # A light load is bounded by the contraction that the maker permits.
    assert shared(single_muscle_joint(load=Mass(mass=2.0))).reach[1] == pytest.approx(0.25 * 0.4)
    narrow = Limits(pressure_low=200e3, pressure_high=300e3)
    low, high = shared(joint, narrow).reach
    assert low == pytest.approx(rest(202e3, weight), abs=1e-6)
    assert high == pytest.approx(rest(298e3, weight), abs=1e-6)


def test_a_load_without_a_muscle_has_no_bounds():
    assert shared(cart()).reach == (-float('inf'), float('inf'))


HEAVY_ARM = Arm(mass=100.0, arm=0.5, hanging_at=-1.5)


@pytest.mark.parametrize(
    ('joint', 'high'),
    [
        (single_muscle_joint(load=Mass(mass=130.0)), 100e3),
        (Joint((Actuator(contraction=0.1),) * 2, HEAVY_ARM, Pulley(radius=0.01)), 50e3),
        # On a level track it would have to push.
        (single_muscle_joint(load=Mass(mount='horizontal'), effects=[Slack(share=1.0)]), 600e3),
    ],
    ids=['mass', 'arm', 'cart'],
)
def test_a_load_that_the_muscles_cannot_hold_is_refused(joint, high):
    with pytest.raises(ParameterError, match='cannot be held anywhere'):
        shared(joint, Limits(pressure_high=high))


def parallel(*effects):
    muscles = (Actuator(effects=effects), Actuator(Muscle(l0=0.38)))
    return Joint(muscles, Mass(mass=40.0), Straight())


def crank():
    return Joint((Actuator(contraction=0.1),), Arm(hanging_at=-0.6), Lever())


@pytest.mark.parametrize(
    'joint', [single_muscle_joint(), parallel(), crank()], ids=['one', 'two', 'crank']
)
def test_one_side_has_the_pressure_that_gives_the_effort(joint):
    allocation = shared(joint)
    assert isinstance(allocation, OneSide)
    assert not allocation.can_stiffen
    low, high = allocation.reach
    bounds = statics.span(joint)
    assert bounds[0] <= low < high <= bounds[1]
    for s in np.linspace(low, high, 9).tolist():
        effort = allocation.model.gravity(s) * 1.05
        split = allocation.split(effort, 0.0, s)
        assert split.short == 0.0
        assert len(set(split.pressures)) == 1
        assert allocation.model.effort(split.pressures, s) == pytest.approx(effort, rel=1e-9)
        h = 1e-3
        more = [p + h for p in split.pressures]
        slope = (allocation.model.effort(more, s) - effort) / h
        assert sum(allocation.gains(s)) == pytest.approx(slope, rel=1e-4)
        # At rest, where the stiffness is settled by the load.
        least, most = allocation.stiffness_range(s)
        assert least == most
        p = allocation.split(allocation.model.gravity(s), 0.0, s).pressures
        assert least == pytest.approx(statics.stiffness(joint, p, s), rel=1e-9)


@pytest.mark.parametrize('joint', [parallel(), crank()], ids=['two', 'crank'])
def test_the_reach_of_one_side_is_where_its_limits_hold_the_load(joint):
    allocation = shared(joint)
    ends = [statics.equilibrium(joint, share * 600e3) for share in (0.02, 0.98)]
    bounds = statics.span(joint)
    assert allocation.reach[0] == pytest.approx(max(min(ends), bounds[0]))
    assert allocation.reach[1] == pytest.approx(min(max(ends), bounds[1]))


def hanging(at=0.0, **slack):
    muscle = Actuator(effects=[Slack(share=1.0, **slack)], contraction=0.1)
    return Joint((muscle,), Arm(hanging_at=at), Lever())


@pytest.mark.parametrize('at', [-0.6, 0.0, 0.5])
def test_a_muscle_that_cannot_push_holds_no_arm_below_where_it_hangs(at):
    joint = hanging(at)
    allocation = shared(joint)
    low, high = allocation.reach
    pushing = shared(Joint((Actuator(contraction=0.1),), joint.load, joint.transmission)).reach
    assert pushing[0] < at - 0.3
    assert high == pytest.approx(pushing[1], rel=1e-6)
    # It begins where the corner of the toe, a quarter of 2 N there, holds the arm.
    arm = abs(float(statics.arm(joint, 0, low)))
    assert 9.80665 * 0.25 * np.sin(low - at) == pytest.approx(0.25 * 2.0 * arm, rel=1e-3)


def test_what_a_muscle_may_push_before_it_buckles_is_in_the_reach():
    joint = hanging(push=10.0)
    low = shared(joint).reach[0]
    arm = abs(float(statics.arm(joint, 0, low)))
    assert 9.80665 * 0.25 * np.sin(low) == pytest.approx((0.25 * 2.0 - 10.0) * arm, rel=1e-3)


def test_muscles_that_pull_everywhere_in_the_reach_have_the_same_one_if_they_cannot_push():
    assert shared(parallel(Slack(share=1.0))).reach == pytest.approx(shared(parallel()).reach)


def test_a_muscle_is_given_no_pressure_that_is_too_low_to_have_an_effect():
    allocation = shared(hanging())
    (muscle,) = allocation.model.at(0.2).muscles
    split = allocation.split(-2.0, 0.0, 0.2)
    assert split.pressures == allocation.least(0.2)
    assert muscle.force_law(split.pressures[0]) == pytest.approx(0, abs=1e-9)
    assert split.short == pytest.approx(-2.0)
    assert allocation.split(2.0, 0.0, 0.2).short == 0.0


# Two sides ---------------------------------------------------------------------------------------

SHARING = shared(pair())
MODEL = SHARING.model


def efforts(angle):
    """Return the least and the greatest torque in N m that the muscles can give."""
    found = []
    for effort in (-1e4, 1e4):
        found.append(effort - SHARING.split(effort, 20.0, angle).short)
    return found


@given(st.floats(-0.4, 0.4), st.floats(0.0, 1.0))
def test_the_split_holds_the_load_with_any_stiffness_that_can_be_had(angle, share):
    low, high = SHARING.stiffness_range(angle)
    k = low + share * (high - low)
    split = SHARING.split(MODEL.gravity(angle), k, angle)
    assert split.short == 0.0
    expected = co_contraction.co_contraction_pressures(MODEL.joint, angle, k)
    np.testing.assert_allclose(split.pressures, expected, rtol=1e-6, atol=1e-3)
    assert MODEL.effort(split.pressures, angle) == pytest.approx(MODEL.gravity(angle), abs=1e-9)
    assert MODEL.stiffness(split.pressures, angle) == pytest.approx(k, rel=1e-9)


def test_the_range_is_that_of_the_rig_less_the_margin():
    low, high = SHARING.stiffness_range(0.1)
    least, most = co_contraction.joint_stiffness_range(MODEL.joint, 0.1)
    assert least * (1.0 - 1e-9) <= low < high < most
    with pytest.raises(RangeError, match=rf'99 N m/rad.*0.1 rad.*{low:.4g} to {high:.4g} N m/rad'):
        SHARING.refuse_stiffness(99.0, 0.1)
    with pytest.raises(RangeError, match='nan'):
        SHARING.refuse_stiffness(float('nan'), 0.1)


@pytest.mark.parametrize('k', [0.0, 1e3])
@pytest.mark.parametrize('torque', [-5.0, 0.0, 5.0])
def test_torque_comes_before_stiffness(torque, k):
    split = SHARING.split(torque, k, 0.0)
    assert split.short == 0.0
    assert MODEL.effort(split.pressures, 0.0) == pytest.approx(torque, abs=1e-9)
    for p, (low, high) in zip(split.pressures, SHARING.ranges, strict=True):
        assert low <= p <= high


def test_torque_beyond_reach_is_given_as_far_as_can_be():
    least, most = efforts(0.0)
    for wanted, end in ((most + 7.0, most), (least - 7.0, least)):
        split = SHARING.split(wanted, 20.0, 0.0)
        assert split.short == pytest.approx(wanted - end)
        assert MODEL.effort(split.pressures, 0.0) == pytest.approx(end)
    # One muscle with all its pressure, the other one at the pressure at which it is slack.
    high = SHARING.ranges[0][1], SHARING.ranges[1][1]
    slack = [line.slack for line in SHARING.lines(0.0)]
    assert most == pytest.approx(MODEL.effort((high[0], max(slack[1], 0.0)), 0.0))
    assert least == pytest.approx(MODEL.effort((max(slack[0], 0.0), high[1]), 0.0))


def test_what_is_available_is_between_the_least_and_the_greatest_torque():
    least, most = efforts(0.5 * sum(SHARING.reach))
    assert SHARING.available() == pytest.approx(most - least)


def test_no_muscle_is_given_a_pressure_at_which_it_pushes():
    for torque in np.linspace(*efforts(0.2), 20):
        pressures = SHARING.split(float(torque), 0.0, 0.2).pressures
        for muscle, p in zip(MODEL.at(0.2).muscles, pressures, strict=True):
            assert muscle.force_law(p) >= -1e-6


def test_within_its_reach_it_can_be_held_and_beyond_it_not():
    low, high = SHARING.reach
    travel = statics.span(MODEL.joint)
    assert travel[0] <= low < high <= travel[1]
    for angle in np.linspace(low, high, 50):
        k = SHARING.stiffness_range(float(angle))
        assert k[0] <= k[1]
        assert SHARING.split(MODEL.gravity(float(angle)), k[1], float(angle)).short == 0.0
    narrow = shared(pair(), Limits(pressure_high=3e5))
    assert narrow.reach[0] >= low
    assert narrow.reach[1] <= high


def test_each_muscle_keeps_its_own_effects():
    lag = (PressureLag(fill=0.03, vent=0.05),)
    joint = pair(effects=((), lag))
    assert [one.effects for one in shared(joint).model.joint.actuators] == [(), lag]
    lever = Joint(joint.actuators, Arm(), Lever())
    assert [PressurePath(lever, i, 0.02).is_lag_configured for i in (0, 1)] == [False, True]


def test_a_lever_has_torque_and_stiffness_of_its_own_equations():
    hung = Actuator(contraction=0.1)
    allocation = shared(Joint((hung, hung), Arm(hanging_at=0.2), Lever()))
    assert allocation.can_stiffen
    for angle in (-0.3, 0.0, 0.4):
        low, high = allocation.stiffness_range(angle)
        k, torque = 0.5 * (low + high), allocation.model.gravity(angle)
        pressures = allocation.split(torque, k, angle).pressures
        assert allocation.model.effort(pressures, angle) == pytest.approx(torque, abs=1e-9)
        assert statics.stiffness(allocation.model.joint, pressures, angle) == pytest.approx(k)


# Several on each side ----------------------------------------------------------------------------


def test_muscles_of_one_side_have_one_pressure():
    hung = Actuator(contraction=0.1)
    joint = Joint((hung,) * 4, Arm(mass=2.0), Pulley())
    allocation, two = shared(joint), shared(Joint((hung, hung), Arm(mass=2.0), Pulley()))
    split = allocation.split(3.0, 60.0, 0.1)
    one, other, third, fourth = split.pressures
    assert (one, other) == (third, fourth)
    assert allocation.model.effort(split.pressures, 0.1) == pytest.approx(3.0, abs=1e-9)
    assert allocation.model.stiffness(split.pressures, 0.1) == pytest.approx(60.0)
    # Twice the muscles do the same with half of it each.
    np.testing.assert_allclose(two.split(1.5, 30.0, 0.1).pressures, split.pressures[:2])
