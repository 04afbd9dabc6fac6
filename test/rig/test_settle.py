# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where joints with effects rest: balances of their own, and rigs that stay there."""

import numpy as np
import pytest
from scipy.optimize import brentq

from pam_ros.rig import settle, statics
from pam_ros.rig.rig import Rig
from support import joints
from support.joint_models import UNEQUAL, pair

SLACK = {'slack': {'share': 1.0}}
STOP = {'end_stop': {'lower': -0.3, 'lower_stiffness': 2e3}}
PAYLOAD = {'payload': {'mass': 0.8}}
CASES = [
    ((SLACK, SLACK), {}, (0.0, 0.0)),
    ((SLACK, SLACK), STOP, (0.0, 0.0)),
    (({}, {}), STOP, (0.0, 5e5)),
    (({'length_offset': {'offset': 0.02}}, {}), {}, (3e5, 3e5)),
    (({}, {'pressure_offset': {'offset': 3e4}}), PAYLOAD, (3e5, 2e5)),
    (({}, {}), {'coulomb_friction': {'level': 1.0}}, (3e5, 2e5)),
]


@pytest.mark.parametrize(('effects', 'load', 'p'), CASES)
def test_a_joint_that_starts_at_rest_stays_there(effects, load, p):
    model = pair(effects=effects, load=load)
    rest = model.rest(p)
    rig = Rig([model])
    rig.reset(p, [rest], [0.0])
    rig.advance(1000)
    assert rig.position[0] == pytest.approx(rest, abs=1e-9)
    assert abs(rig.velocity[0]) < 1e-9


def test_vented_muscles_that_cannot_push_let_the_arm_hang():
    """It hangs straight down but for what the muscles at their lengths without force allow."""
    model = pair(effects=(SLACK, SLACK))
    assert statics.equilibrium(model, 0.0) != pytest.approx(joints.HANGING_AT, abs=0.1)
    assert model.rest(0.0) == pytest.approx(joints.HANGING_AT, abs=1e-6)


def test_a_stop_holds_what_the_muscles_do_not():
    model = pair(load=STOP)

    def left(angle):
        # What a step of 1 ms does not resolve is softened.
        k = 2e3 / np.hypot(1.0, 2e3 * 1e-6 / joints.J)
        push = k * max(-0.3 - angle, 0.0)
        return joints.torque((0.0, 5.0), angle, UNEQUAL) - joints.gravity(angle) + push

    root = brentq(left, -1.0, 0.0, xtol=1e-14)
    assert root < -0.3
    assert model.rest([0.0, 5e5]) == pytest.approx(root, abs=1e-9)


def test_without_effects_it_is_the_equilibrium():
    model = pair()
    assert settle.rest(model, [4e5, 3e5]) == statics.equilibrium(model, [4e5, 3e5])
    a = settle.held(model, [4e5, 3e5])
    net = joints.torque((4.0, 3.0), 0.2, UNEQUAL) - joints.gravity(0.2)
    assert a(0.2) == pytest.approx(net / joints.J, rel=1e-10)
