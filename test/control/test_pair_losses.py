# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Declared friction and hysteresis of a pair, fed forward: against the rig that has them."""

import math

import numpy as np
import pytest
from pam_ros.control.pair_gains import PairGains
from pam_ros.control.pair_law import PairLaw
from pam_ros.control.pair_losses import PairLosses
from pam_ros.control.pair_model import PairModel
from pam_ros.rig.joint_model import Actuator, JointModel

from pam_ros.control.signals import Reference
from pam_ros.rig.rig import Rig

DT = 2e-3
FRICTION = {'coulomb_friction': {'level': 0.3}}
HYSTERESIS = {'hysteresis': {'slip': 20.0}}


def sine(t):
    w, a = math.pi, 0.25
    return Reference(a * math.sin(w * t), a * w * math.cos(w * t), -a * w * w * math.sin(w * t))


def rms(told, true, seconds=6.0):
    law, rig = PairLaw(told, PairGains()), Rig([true])
    law.start(0.0)
    rig.reset(law.terms.pressures, [0.0], [0.0])
    errors = []
    for n in range(round(seconds / DT)):
        now = sine(n * DT)
        errors.append(now.position - rig.position[0])
        rig.command(law.update(DT, now, float(rig.position[0])))
        rig.advance(2)
    return float(np.sqrt(np.mean(np.square(errors[-1000:]))))


def test_nothing_is_lost_where_nothing_is_declared():
    losses = PairLosses(PairModel(JointModel()))
    losses.start(0.0, (3e5, 3e5))
    assert losses.follow(DT, Reference(0.1, 1.0), (3e5, 3e5)) == 0.0


def test_friction_of_the_load_is_a_torque_and_resists_the_motion():
    losses = PairLosses(PairModel(JointModel(effects=FRICTION)))
    losses.start(0.0, (3e5, 3e5))
    for n in range(200):
        lost = losses.follow(DT, Reference(0.5 * n * DT, 0.5), (3e5, 3e5))
    assert lost == pytest.approx(0.3, rel=0.02)
    for n in range(200):
        lost = losses.follow(DT, Reference(0.2 - 0.5 * n * DT, -0.5), (3e5, 3e5))
    assert lost == pytest.approx(-0.3, rel=0.02)


@pytest.mark.parametrize('which', ['friction', 'hysteresis'])
def test_what_is_declared_is_compensated(which):
    if which == 'friction':
        true = JointModel(effects=FRICTION)
    else:
        one = Actuator(effects=HYSTERESIS)
        true = JointModel(actuators=(one, one))
    known, unknown = rms(true, true), rms(JointModel(), true)
    assert unknown > math.radians(0.05)
    assert known < 0.35 * unknown
