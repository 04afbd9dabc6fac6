# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a rig publishes in addition to its motion, by the equations of each joint."""

import numpy as np
import pytest

from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support import joints, paper
from support.joint_models import UNEQUAL, lever, pair

MASS, ZETA = 20.0, 0.15
WEIGHT = MASS * paper.G


def test_outputs_are_the_papers():
    rig = Simulation([single_muscle_joint()])
    rig.reset([4e5], [0.05], [0.3])
    force, k, c, acceleration = np.ravel(rig.muscle_outputs())
    assert force == pytest.approx(paper.force(4.0, 12.5), abs=1e-9)
    assert k == pytest.approx(paper.stiffness(4.0, 12.5), rel=1e-12)
    assert c == pytest.approx(paper.damping(4.0, 12.5, MASS, ZETA), rel=1e-12)
    assert acceleration == pytest.approx((force - c * 0.3 - WEIGHT) / MASS, rel=1e-12)


def test_outputs_are_those_of_the_equations():
    rig = Simulation([pair()])
    rig.reset([4.2e5, 2.9e5], [0.3], [2.0])
    p, y = (4.2, 2.9), joints.ends(0.3, UNEQUAL)
    found = rig.muscle_outputs()
    effort, stiffness, acceleration = np.ravel(rig.joint_outputs())
    k = [strand.stiffness(*each) for strand, *each in zip(UNEQUAL, p, y, strict=True)]
    for i, strand in enumerate(UNEQUAL):
        assert found.force[i] == pytest.approx(strand.force(p[i], y[i]), abs=1e-8)
        assert found.stiffness[i] == pytest.approx(k[i], rel=1e-12)
        c = 2.0 * joints.ZETA * np.sqrt(joints.J / (2.0 * joints.R**2) * k[i])
        assert found.damping[i] == pytest.approx(c, rel=1e-12)
    tau = joints.torque(p, 0.3, UNEQUAL)
    assert effort == pytest.approx(tau, abs=1e-9)
    assert stiffness == pytest.approx(joints.R**2 * sum(k), rel=1e-12)
    net = tau - 2.0 * joints.drag(p, 0.3, UNEQUAL) - joints.gravity(0.3)
    assert acceleration == pytest.approx(net / joints.J, rel=1e-10)
    ends = [joints.R * acceleration, -joints.R * acceleration]
    np.testing.assert_allclose(found.acceleration, ends)
    l0 = [strand.l0 for strand in UNEQUAL]
    np.testing.assert_allclose(rig.contraction, np.divide(y, l0), rtol=1e-14)


def test_outputs_of_a_lever_are_those_of_the_equations():
    """The ends of the muscles accelerate also because their arms change: arm' v^2."""
    rig, angle, rate, h = Simulation([lever()]), 0.3, 2.0, 1e-5
    rig.reset([4.2e5, 2.9e5], [angle], [rate])
    p, kappas = (4.2, 2.9), (joints.KAPPA_1, joints.KAPPA_2)
    y = [kappas[i] * strand.l0 + joints.drawn(angle, i) for i, strand in enumerate(UNEQUAL)]
    found = rig.muscle_outputs()
    effort, stiffness, acceleration = np.ravel(rig.joint_outputs())
    drag = 0.0
    for i, strand in enumerate(UNEQUAL):
        r = joints.lever_arm(angle, i)
        turn = (joints.lever_arm(angle + h, i) - joints.lever_arm(angle - h, i)) / (2.0 * h)
        assert found.force[i] == pytest.approx(strand.force(p[i], y[i]), abs=1e-8)
        assert found.stiffness[i] == pytest.approx(strand.stiffness(p[i], y[i]), rel=1e-12)
        c = 2.0 * joints.ZETA * np.sqrt(joints.J / (2.0 * r**2) * found.stiffness[i])
        assert found.damping[i] == pytest.approx(c, rel=1e-12)
        assert found.acceleration[i] == pytest.approx(r * acceleration + turn * rate**2, rel=1e-8)
        drag += r**2 * c
    assert effort == pytest.approx(joints.lever_torque(p, angle, UNEQUAL), abs=1e-9)
    ends = (joints.lever_torque(p, angle + way, UNEQUAL) for way in (h, -h))
    assert stiffness == pytest.approx((next(ends) - next(ends)) / (-2.0 * h), rel=1e-7)
    net = effort - drag * rate - joints.gravity(angle)
    assert acceleration == pytest.approx(net / joints.J, rel=1e-10)
    np.testing.assert_allclose(rig.contraction, np.divide(y, [s.l0 for s in UNEQUAL]), rtol=1e-14)
