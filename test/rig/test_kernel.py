# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The integrator against scipy's DOP853 on the paper's equations, and against conservation."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import layout as at
from pam_ros.rig.joint import one_muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.rest import rest
from pam_ros.rig.rig import Rig
from pam_ros.rig.run import simulate
from pam_ros.rig.start import start_state
from support import paper, smooth_supply

MASS, ZETA = 20.0, 0.15
WEIGHT = MASS * paper.G


def solve(p_of_t, start, t, g=paper.G, zeta=ZETA):
    """Return y and v, upwards, at the stamps t by DOP853 at rtol 1e-10 or tighter."""
    rhs = paper.pendulum(p_of_t, MASS, zeta, g)
    y, v = start
    found = solve_ivp(rhs, (t[0], t[-1]), (-y, -v), 'DOP853', t, rtol=1e-12, atol=1e-14)
    assert found.success
    return -found.y


def swinging(step=1e-3, t=None, position=0.1):
    """Run the rig under the smooth supply, from rest at a position; return its trajectory."""
    model = one_muscle(library=(smooth_supply.EFFECT,))
    t = np.linspace(0.0, 10.0, 2001) if t is None else t
    return simulate(model, t, [0.0], [0.0], position=position, step=step)


@pytest.mark.parametrize('position', [0.0, 0.05, 0.0973])
def test_the_papers_experiment_is_within_a_nanometre_of_dop853(position):
    """600 kPa, 20 kg, released; 10 s at the default step."""
    t = np.linspace(0.0, 10.0, 2001)
    found = simulate(one_muscle(), t, [0.0], [6e5], position=position)
    y, v = solve(lambda _: 6.0, (position, 0.0), t)
    assert np.max(np.abs(found.position - y)) < 1e-9
    assert np.max(np.abs(found.velocity - v)) < 3e-8
    assert found.force[-1] == pytest.approx(WEIGHT, abs=1e-6)  # it has come to rest


@pytest.mark.slow
def test_a_smooth_command_is_within_a_nanometre_of_dop853():
    t = np.linspace(0.0, 10.0, 2001)
    y, v = solve(smooth_supply.at, (0.1, 0.0), t)
    found = swinging()
    assert np.ptp(y[t > 5.0]) > 0.01
    assert np.max(np.abs(found.position - y)) < 1e-9
    assert np.max(np.abs(found.velocity - v)) < 3e-8


def test_a_staircase_of_commands_is_within_a_nanometre_of_dop853():
    """Commands at 50 Hz, each held to the next: the solver starts anew at each."""
    model = one_muscle()
    rig = Rig([model])
    rig.reset([3e5], [rest(model, 3e5)], [0.0])
    state = np.array([rig.position[0], 0.0])
    for k in range(150):
        p = 3e5 + 2e5 * np.sin(0.13 * k)
        rig.command(p)
        rig.advance(20)
        state = solve(lambda _, p=p: p / 1e5, state, np.array([0.0, 0.02]))[:, -1]
        assert rig.position[0] == pytest.approx(state[0], abs=1e-9)
    assert rig.time == 3.0


def test_the_order_of_convergence_is_four():
    t = np.array([0.0, 0.96])
    exact = solve(smooth_supply.at, (0.1, 0.0), t)[0, -1]
    steps = np.array([6e-3, 3e-3, 1.5e-3, 0.75e-3])
    errors = [abs(swinging(step, t).position[-1] - exact) for step in steps]
    orders = np.diff(np.log(errors)) / np.diff(np.log(steps))
    assert np.all(np.abs(orders - 4.0) < 0.3), orders


def test_richardson_sees_the_same_order_without_a_reference():
    t = np.array([0.0, 0.96])
    y = [swinging(step, t).position[-1] for step in (4e-3, 2e-3, 1e-3)]
    assert np.log2((y[0] - y[1]) / (y[1] - y[2])) == pytest.approx(4.0, abs=0.2)


def energy(rig):
    """Return the energy in J of the undamped paper's rig at 600 kPa, by the paper's force."""
    y, v = rig.position[0], rig.velocity[0]
    work, _ = quad(lambda s: paper.force(6.0, 100.0 * s / paper.L0), 0.0, y, epsabs=1e-13)
    return 0.5 * MASS * v * v + WEIGHT * y - work


@pytest.mark.needs_numba
def test_energy_without_damping_drifts_by_a_ten_millionth_in_a_minute():
    """Swinging by 75 mm with 9.7 J: the scheme takes 1.1e-8 J a second and gives none."""
    model = one_muscle(Muscle(zeta=0.0))
    rig = Rig([model])
    rig.reset([6e5], [rest(model, 6e5)], [0.0])
    bottom = energy(rig)
    rig.reset([6e5], [0.06], [0.0])
    start = energy(rig)
    assert start - bottom == pytest.approx(9.7087, abs=1e-3)
    drift = []
    for _ in range(60):
        rig.advance(1000)
        drift.append(energy(rig) - start)
    assert min(drift) > -1e-6
    assert max(drift) < 1e-7  # it comes and goes by that much within a period
    # It is the scheme's own loss, a fifth power of the step, and not a fault: half the step,
    # a thirty-second of the loss.
    fine = Rig([model], 5e-4)
    fine.reset([6e5], [0.06], [0.0])
    fine.advance(120_000)
    assert (energy(fine) - start) / drift[-1] == pytest.approx(1.0 / 32.0, rel=0.2)


def test_a_horizontal_load_feels_no_gravity():
    model = one_muscle(load=Mass(mount='horizontal'))
    t = np.linspace(0.0, 3.0, 301)
    found = simulate(model, t, [0.0], [3e5], position=0.05)
    y, _ = solve(lambda _: 3.0, (0.05, 0.0), t, g=0.0)
    assert np.max(np.abs(found.position - y)) < 1e-9
    assert found.position[-1] == pytest.approx(rest(model, 3e5), abs=1e-5)
    assert found.force[-1] == pytest.approx(0.0, abs=0.1)


def test_outputs_are_the_papers():
    rig = Rig([one_muscle()])
    rig.reset([4e5], [0.05], [0.3])
    force, k, c, acceleration = rig.outputs()[0]
    assert force == pytest.approx(paper.force(4.0, 12.5), abs=1e-9)
    assert k == pytest.approx(paper.stiffness(4.0, 12.5), rel=1e-12)
    assert c == pytest.approx(paper.damping(4.0, 12.5, MASS, ZETA), rel=1e-12)
    assert acceleration == pytest.approx((force - c * 0.3 - WEIGHT) / MASS, rel=1e-12)


def test_templates_run_as_they_stand():
    """Unbound and uncompiled they are the paper's rig, as their module says."""
    from pam_ros.rig import kernel

    model = one_muscle(library=())
    q = model.parameters()
    x = start_state(model.layout, q, [3e5], 0.02, 0.0)
    scratch = model.layout.scratch()
    for i in range(50):
        kernel.step(x, scratch, q, [3e5], i * 1e-3, 1e-3)
    y, v = solve(lambda _: 3.0, (0.02, 0.0), np.array([0.0, 0.05]))
    assert x[at.JOINT, at.S] == pytest.approx(y[-1], abs=1e-9)
    assert x[at.JOINT, at.V] == pytest.approx(v[-1], abs=3e-8)
