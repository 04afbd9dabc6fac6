# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The pair as a law sees it, against the closed forms of the rig and equations of its own."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.control.limits import Limits
from pam_ros.control.pair_model import PairModel
from pam_ros.errors import ParameterError, RangeError
from pam_ros.rig import statics
from pam_ros.rig.joint_model import Actuator, JointModel
from pam_ros.rig.joints.antagonistic_pair import PulleyArm
from pam_ros.rig.rig import Rig
from support import joints
from support.joint_models import UNEQUAL, pair

BAR = 1e5
RIG = PairModel(pair())


@pytest.mark.parametrize('angle', [-0.4, 0.0, 0.3])
def test_torque_stiffness_and_damping_are_those_of_the_equations(angle):
    p = (4.0, 3.0)
    pascal = (4e5, 3e5)
    assert RIG.effort(pascal, angle) == pytest.approx(joints.torque(p, angle, UNEQUAL))
    assert RIG.gravity(angle) == pytest.approx(joints.gravity(angle))
    assert RIG.damping(pascal, angle, 0.5) == pytest.approx(joints.drag(p, angle, UNEQUAL))
    k = joints.R**2 * sum(
        strand.stiffness(each, y)
        for strand, each, y in zip(UNEQUAL, p, joints.ends(angle, UNEQUAL), strict=True)
    )
    assert RIG.stiffness(pascal, angle) == pytest.approx(k)
    h = 1e-5
    slope = (joints.gravity(angle + h) - joints.gravity(angle - h)) / (2.0 * h)
    assert RIG.gravity_stiffness(angle) == pytest.approx(slope, rel=1e-6)
    rate = 0.7
    net = joints.torque(p, angle, UNEQUAL) - joints.gravity(angle)
    net -= joints.drag(p, angle, UNEQUAL) * rate
    assert RIG.pull(pascal, angle, rate) == pytest.approx(net)


def test_its_acceleration_is_the_rigs():
    model = pair(load={'viscous_friction': {'coefficient': 0.2}, 'payload': {'mass': 0.4}})
    seen, rig = PairModel(model), Rig([model])
    rig.reset([4e5, 2e5], [0.1], [1.3])
    acceleration = rig.joint_outputs()[0, 2]
    assert seen.pull((4e5, 2e5), 0.1, 1.3) / seen.mass == pytest.approx(acceleration, rel=1e-9)


@given(st.floats(-0.4, 0.4), st.floats(0.0, 1.0))
def test_the_split_holds_the_load_with_any_stiffness_that_can_be_had(angle, share):
    low, high = RIG.stiffness_range(angle)
    k = low + share * (high - low)
    split = RIG.split(RIG.gravity(angle), k, angle)
    assert split.short == 0.0
    expected = statics.pressures(RIG.model, angle, k)
    np.testing.assert_allclose(split.pressures, expected, rtol=1e-6, atol=1e-3)
    assert RIG.effort(split.pressures, angle) == pytest.approx(RIG.gravity(angle), abs=1e-9)
    assert RIG.stiffness(split.pressures, angle) == pytest.approx(k, rel=1e-9)


def test_the_range_is_that_of_the_rig_less_the_margin():
    low, high = RIG.stiffness_range(0.1)
    least, most = statics.stiffness_range(RIG.model, 0.1)
    assert least * (1.0 - 1e-9) <= low < high < most
    with pytest.raises(RangeError, match=rf'99 N m/rad.*0.1 rad.*{low:.4g} to {high:.4g} N m/rad'):
        RIG.refuse_stiffness(99.0, 0.1)
    with pytest.raises(RangeError, match='nan'):
        RIG.refuse_stiffness(float('nan'), 0.1)


@pytest.mark.parametrize('k', [0.0, 1e3])
@pytest.mark.parametrize('torque', [-5.0, 0.0, 5.0])
def test_torque_comes_before_stiffness(torque, k):
    split = RIG.split(torque, k, 0.0)
    assert split.short == 0.0
    assert RIG.effort(split.pressures, 0.0) == pytest.approx(torque, abs=1e-9)
    for p, (low, high) in zip(split.pressures, RIG.ranges, strict=True):
        assert low <= p <= high


def test_torque_beyond_reach_is_given_as_far_as_can_be():
    least, most = RIG.efforts(0.0)
    for wanted, end in ((most + 7.0, most), (least - 7.0, least)):
        split = RIG.split(wanted, 20.0, 0.0)
        assert split.short == pytest.approx(wanted - end)
        assert RIG.effort(split.pressures, 0.0) == pytest.approx(end)


def test_no_muscle_is_told_to_push():
    for torque in np.linspace(*RIG.efforts(0.2), 20):
        pressures = RIG.split(float(torque), 0.0, 0.2).pressures
        for i, p in enumerate(pressures):
            assert RIG.force(p, 0.2, i) >= -1e-6


def test_within_its_reach_it_can_be_held_and_beyond_it_not():
    low, high = RIG.reach
    travel = RIG.model.travel
    assert travel[0] <= low < high <= travel[1]
    for angle in np.linspace(low, high, 50):
        k = RIG.stiffness_range(float(angle))
        assert k[0] <= k[1]
        assert RIG.split(RIG.gravity(float(angle)), k[1], float(angle)).short == 0.0
    narrow = PairModel(pair(), Limits(pressure_high=3e5))
    assert narrow.reach[0] >= low
    assert narrow.reach[1] <= high


def test_a_load_that_cannot_be_held_is_refused():
    model = JointModel(PulleyArm(radius=0.01, mass=100.0, arm=0.5, hanging_at=-1.5))
    with pytest.raises(ParameterError, match='cannot be held anywhere'):
        PairModel(model, Limits(pressure_high=50e3))


def test_each_muscle_keeps_its_own_pressure_path():
    lag = {'pressure_lag': {'fill': 0.03, 'vent': 0.05}}
    rig = PairModel(JointModel(actuators=(Actuator(), Actuator(effects=lag))))
    assert [m.effects for m in rig.muscles] == [{}, lag]
