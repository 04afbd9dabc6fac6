# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Effects in the muscles of a joint and on it, each against equations of its own."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pam_ros.effects import (
    CoulombFriction,
    EndStop,
    Hysteresis,
    Payload,
    PressureLag,
    ViscousFriction,
)
from pam_ros.rig import statics
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.simulation import Simulation
from support import joints, paper
from support.joint_models import UNEQUAL, pair
from support.joint_runs import BAR, run, solve


def test_a_lag_in_one_muscle_of_the_pair():
    lag = [PressureLag(fill=0.08, vent=0.2)]
    t = np.linspace(0.0, 1.0, 101)
    rig = Simulation([pair(effects=((), lag))])
    rig.reset([3e5, 3e5], [0.0], [0.0])
    rig.command([2e5, 5e5])
    found = [0.0]
    for _ in t[1:]:
        rig.advance(10)
        found.append(rig.position[0])
    np.testing.assert_allclose(rig.pressure, [2e5, 5e5 - 2e5 * np.exp(-1.0 / 0.08)], rtol=1e-12)
    rhs = joints.pair(lambda s: (2.0, 5.0 - 2.0 * np.exp(-s / 0.08)), UNEQUAL)
    angle, _ = solve(rhs, (0.0, 0.0), t)
    np.testing.assert_allclose(found, angle, atol=1e-8)


def test_hysteresis_of_one_muscle_of_the_pair():
    """Dahl's law, dz/dkappa = (1 - z sign(v)) / W, on the second muscle, which v lengthens."""
    amplitude, width = 20.0, 0.01
    rub = [Hysteresis(amplitude=amplitude, width=width)]
    t = np.linspace(0.0, 0.5, 51)
    # Towards one side alone: Dahl's law is smooth there, and exact at any step.
    start = (0.0, 0.0)
    found = run(pair(effects=((), rub)), t, start, (4.0 * BAR, 2.0 * BAR), step=1e-4)
    two = UNEQUAL[1]

    def rhs(_, state):
        angle, rate, z = state
        p = 4.0, 2.0
        kappa_rate = -joints.R * rate / two.l0
        tau = joints.torque(p, angle, UNEQUAL) + joints.R * amplitude * z
        net = tau - joints.drag(p, angle, UNEQUAL) * rate - joints.gravity(angle)
        return rate, net / joints.J, (kappa_rate - abs(kappa_rate) * z) / width

    run_of_it = solve_ivp(
        rhs, (0.0, 0.5), (*start, 0.0), 'DOP853', t, rtol=1e-10, atol=1e-12, max_step=1e-3
    )
    assert np.ptp(run_of_it.y[2]) > 0.5
    np.testing.assert_allclose(found[0], run_of_it.y[0], atol=1e-6)
    free = run(pair(), t, start, (4.0 * BAR, 2.0 * BAR))
    assert np.max(np.abs(free[0] - found[0])) > 1e-2


def test_friction_of_the_pivot_and_a_payload_on_the_arm():
    """Viscous friction in N m s/rad; a payload moves, and weighs, at the end of the arm."""
    friction, more = 0.4, 0.7
    on_load = [ViscousFriction(coefficient=friction), Payload(mass=more)]
    t = np.linspace(0.0, 2.0, 201)
    model = pair(load=on_load)
    found = run(model, t, (0.5, 0.0), (4.2 * BAR, 2.9 * BAR))
    j = joints.J + more * joints.ARM**2
    assert model.inertia == pytest.approx(j, rel=1e-14)
    p = 4.2, 2.9

    def rhs(_, state):
        angle, rate = state
        c = joints.drag(p, angle, UNEQUAL) * np.sqrt(j / joints.J) + friction
        down = joints.gravity(angle) * (joints.M + more) / joints.M
        return rate, (joints.torque(p, angle, UNEQUAL) - c * rate - down) / j

    angle, _ = solve(rhs, (0.5, 0.0), t)
    np.testing.assert_allclose(found[0], angle, atol=1e-9)


def test_dry_friction_of_the_pivot_holds_the_arm():
    """It stays where the muscles' torque and gravity differ by less than the friction."""
    rig = Simulation([pair(load=[CoulombFriction(level=0.8)])])
    at_rest = equilibrium(rig.joints[0], [4e5, 3e5])
    k = joints.R**2 * sum(
        strand.stiffness(p, y)
        for strand, p, y in zip(UNEQUAL, (4.0, 3.0), joints.ends(at_rest, UNEQUAL), strict=True)
    )
    reach = 0.8 / (k + joints.M * paper.G * joints.ARM * np.cos(at_rest - joints.HANGING_AT))
    rig.reset([4e5, 3e5], [at_rest + 0.9 * reach], [0.0])
    rig.advance(3000)
    assert rig.position[0] == pytest.approx(at_rest + 0.9 * reach, abs=2e-4)
    rig.reset([4e5, 3e5], [at_rest + 3.0 * reach], [0.0])
    rig.advance(3000)
    assert abs(rig.position[0] - at_rest) < 1.1 * reach
    assert abs(rig.velocity[0]) < 1e-6


def test_a_stop_begins_at_its_angle():
    rig = Simulation([pair(load=[EndStop(upper=0.2, stiffness=1e4)])])
    assert statics.equilibrium(rig.joints[0], [5e5, 1e5]) > 0.5
    rig.command([5e5, 1e5])
    rig.advance(3000)
    pressed = rig.position[0] - 0.2
    push = joints.torque((5.0, 1.0), rig.position[0], UNEQUAL) - joints.gravity(rig.position[0])
    # What a step of 1 ms cannot resolve is softened: 1/hypot(1, k h^2 / J).
    softer = 1e4 / np.hypot(1.0, 1e4 * 1e-6 / joints.J)
    assert pressed == pytest.approx(push / softer, rel=1e-3)
