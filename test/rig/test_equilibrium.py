# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where joints with effects rest: balances of their own, and rigs that stay there."""

import numpy as np
import pytest
from scipy.optimize import brentq

from pam_ros.effects import CoulombFriction, EndStop, LengthOffset, Payload, PressureOffset, Slack
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import statics
from pam_ros.rig.equilibrium import equilibrium, held
from pam_ros.rig.loads import GRAVITY, Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support import joints, paper
from support.joint_models import UNEQUAL, lever, pair, parallel

SLACK = [Slack(share=1.0)]
STOP = [EndStop(lower=-0.3, lower_stiffness=2e3)]
PAYLOAD = [Payload(mass=0.8)]
CASES = [
    ((SLACK, SLACK), (), (0.0, 0.0)),
    ((SLACK, SLACK), STOP, (0.0, 0.0)),
    (((), ()), STOP, (0.0, 5e5)),
    (([LengthOffset(offset=0.02)], ()), (), (3e5, 3e5)),
    (((), [PressureOffset(offset=3e4)]), PAYLOAD, (3e5, 2e5)),
    (((), ()), [CoulombFriction(level=1.0)], (3e5, 2e5)),
]


@pytest.mark.parametrize(('effects', 'load', 'p'), CASES)
@pytest.mark.parametrize('kind', [pair, lever])
def test_a_joint_that_starts_at_rest_stays_there(kind, effects, load, p):
    joint = kind(effects=effects, load=load)
    place = equilibrium(joint, p)
    rig = Simulation([joint])
    rig.reset(p, [place], [0.0])
    rig.advance(1000)
    assert rig.position[0] == pytest.approx(place, abs=1e-9)
    assert abs(rig.velocity[0]) < 1e-9


def test_vented_muscles_that_cannot_push_let_the_arm_hang():
    """It hangs straight down but for what the muscles at their lengths without force allow."""
    joint = pair(effects=(SLACK, SLACK))
    assert statics.equilibrium(joint, 0.0) != pytest.approx(joints.HANGING_AT, abs=0.1)
    assert equilibrium(joint, 0.0) == pytest.approx(joints.HANGING_AT, abs=1e-6)


def test_a_stop_holds_what_the_muscles_do_not():
    joint = pair(load=STOP)

    def left(angle):
        # What a step of 1 ms does not resolve is softened.
        k = 2e3 / np.hypot(1.0, 2e3 * 1e-6 / joints.J)
        push = k * max(-0.3 - angle, 0.0)
        return joints.torque((0.0, 5.0), angle, UNEQUAL) - joints.gravity(angle) + push

    root = brentq(left, -1.0, 0.0, xtol=1e-14)
    assert root < -0.3
    assert equilibrium(joint, [0.0, 5e5]) == pytest.approx(root, abs=1e-9)


def test_without_effects_it_is_the_equilibrium():
    for joint, torque in ((pair(), joints.torque), (lever(), joints.lever_torque)):
        assert equilibrium(joint, [4e5, 3e5]) == statics.equilibrium(joint, [4e5, 3e5])
        a = held(joint, [4e5, 3e5])
        net = torque((4.0, 3.0), 0.2, UNEQUAL) - joints.gravity(0.2)
        assert a(0.2) == pytest.approx(net / joints.J, rel=1e-10)


def test_one_muscle_rests_where_it_holds_the_load():
    joint = single_muscle_joint()
    y = equilibrium(joint, 6e5)
    assert paper.force(6.0, 100.0 * y / paper.L0) == pytest.approx(20.0 * GRAVITY, abs=1e-9)
    free = single_muscle_joint(load=Mass(mount='horizontal'))
    assert paper.force(6.0, 100.0 * equilibrium(free, 6e5) / paper.L0) == pytest.approx(
        0.0, abs=1e-9
    )


def test_a_load_that_a_known_force_drives_rests_at_0():
    source = Muscle(a1=0.0, a2=0.0, a3=0.0, a4=0.0, a5=1.0, a6=0.0, pressure_unit='Pa', zeta=0.0)
    assert equilibrium(single_muscle_joint(source, Mass(mount='horizontal')), 100.0) == 0.0


def test_two_muscles_on_a_mass_rest_where_they_hold_it_together():
    one, two = UNEQUAL
    root = brentq(
        lambda s: one.force(4.0, s) + two.force(3.0, s) - 50.0 * paper.G, -0.05, 0.2, xtol=1e-15
    )
    assert equilibrium(parallel(50.0), [4e5, 3e5]) == pytest.approx(root, abs=1e-12)
