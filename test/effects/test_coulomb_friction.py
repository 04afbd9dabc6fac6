# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Dry friction against closed forms of sliding, and what it must hold at rest."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pam_ros.effects import CoulombFriction, PeriodicDisturbance
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.loads import Mass
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import single_muscle_joint
from support import bench


def dry(**values):
    return [CoulombFriction(**values)]


@pytest.mark.parametrize(
    ('v0', 'level'), [(0.3, 6.0 * 1.2), (-0.3, 6.0 * 0.8)], ids=['up', 'down']
)
def test_coasting_load_brakes_evenly_and_then_stands(v0, level):
    t = np.linspace(0.0, 5.0, 501)
    model = bench.cart(*dry(level=6.0, asymmetry=0.2))
    run = simulate(model, t, [0.0], [0.0], position=0.0, velocity=v0)
    brake = level / bench.MASS
    s = np.minimum(t, abs(v0) / brake)
    expected = v0 * s - np.sign(v0) * 0.5 * brake * s**2
    # The contact's spring gives way by micrometres at either end.
    np.testing.assert_allclose(run.position, expected, atol=2e-5)
    assert np.ptp(run.position[-100:]) < 1e-12
    assert np.all(np.abs(run.velocity[-100:]) < 1e-12)


@pytest.mark.needs_numba
@pytest.mark.parametrize('mass', [0.5, 2.0, 10.0, 100.0])
@pytest.mark.parametrize('level', [0.5, 5.0, 50.0])
def test_stuck_load_stays_where_it_is(mass, level):
    # Shifted from its equilibrium by half of what friction holds: tanh laws creep back here.
    muscle = Muscle(zeta=bench.ZETA)
    model = single_muscle_joint(muscle, Mass(mass=mass), dry(level=level))
    stiffness = float(muscle.stiffness(3e5, equilibrium(model, 3e5) / muscle.l0))
    y0 = equilibrium(model, 3e5) + 0.5 * level / stiffness
    t = np.linspace(0.0, 20.0, 201)
    run = simulate(model, t, [3e5], [0.0], position=y0)
    give = 1e-5 + level * 1e-6 / mass
    assert np.all(np.abs(run.position - y0) < 1.5 * give)
    assert np.ptp(run.position[20:]) < 1e-9
    assert np.all(np.abs(run.velocity[20:]) < 1e-8)


def test_load_does_not_drift_under_a_shaken_force_below_breakaway():
    # Dahl and LuGre ratchet here; measured contacts do not (Dupont et al. 2002).
    shake = {'force_sin': 2.0, 'frequency': 7.0}
    model = bench.cart(*dry(level=6.0), PeriodicDisturbance(**shake))
    t = np.linspace(0.0, 20.0, 2001)
    run = simulate(model, t, [0.0, 3.0], [0.0, 1.0], position=0.0)
    assert np.ptp(run.position) < 3e-5
    first, last = run.position[300:500].mean(), run.position[-200:].mean()
    assert abs(last - first) < 1e-8


def test_load_breaks_away_at_its_level_and_slides_at_the_lower_one():
    m, level, breakaway, speed = bench.MASS, 5.0, 8.0, 0.02
    friction = dry(level=level, breakaway=breakaway, stribeck_speed=speed)
    stamps = np.arange(0.0, 4.0, 0.01)
    ramp = 4.0 * stamps
    t = np.linspace(0.0, 4.0, 401)
    run = simulate(bench.cart(*friction, mass=m), t, ramp, stamps, position=0.0)
    moved = t[np.argmax(run.position > 1e-4)]
    assert 2.0 < moved < 2.15  # 8 N after 2 s, and the time to go 0.1 mm
    assert np.all(run.position[t < 1.95] < 2e-5)

    def rhs(s, state):
        _, v = state
        u = ramp[min(int(s / 0.01 + 1e-9), ramp.size - 1)]
        g = level + (breakaway - level) * np.exp(-((v / speed) ** 2))
        return v, (u - g) / m

    begin = int(np.argmax(run.velocity > 0.02))
    after = t[begin:]
    exact = solve_ivp(
        rhs,
        (after[0], 4.0),
        (run.position[begin], run.velocity[begin]),
        t_eval=after,
        max_step=1e-3,
        rtol=1e-9,
    )
    np.testing.assert_allclose(run.velocity[begin:], exact.y[1], rtol=2e-4)


def test_friction_grows_with_pressure():
    p, growth = 100.0, 0.01
    model = bench.cart(*dry(level=2.0, per_pressure=growth))
    run = simulate(model, [0.0, 0.3], [p], [0.0], position=0.0, velocity=0.5)
    rise = (p - 2.0 - growth * p) / bench.MASS
    assert run.velocity[1] == pytest.approx(0.5 + 0.3 * rise, abs=1e-5)


def swing(y0, level, end, p=3e5):
    """Return when and where an ideal dry slider on the muscle turns, until it sticks."""
    y, t, turns = y0, 0.0, []
    while True:
        net = bench.pull(p, y) - bench.MASS * bench.G
        if abs(net) <= level:
            return turns, y
        way = np.sign(net)

        def rhs(_, state, way=way):
            y, v = state
            f = bench.pull(p, y) - bench.drag(p, y) * v - way * level
            return v, f / bench.MASS - bench.G

        def stands(s, state, t=t, way=way):
            return state[1] if s > t + 1e-6 else way

        stands.terminal = True
        run = solve_ivp(
            rhs, (t, t + end), (y, 0.0), events=stands, rtol=1e-10, atol=1e-12, max_step=1e-3
        )
        y, t = run.y[0, -1], run.t[-1]
        turns.append((t, y))


def test_swing_dies_in_the_turns_and_where_an_ideal_slider_sticks():
    level = 6.0
    y0 = bench.rest(3e5) + 0.02
    turns, stuck = swing(y0, level, end=2.0)
    t = np.linspace(0.0, 4.0, 4001)
    run = simulate(bench.hanging(*dry(level=level)), t, [3e5], [0.0], position=y0)
    assert len(turns) >= 4
    at_turns = np.interp([s for s, _ in turns], t, run.position)
    np.testing.assert_allclose(at_turns, [y for _, y in turns], atol=6e-5)
    np.testing.assert_allclose(run.position[-1], stuck, atol=6e-5)


@pytest.mark.parametrize('step', [1e-3, 4e-3])
def test_a_light_load_with_much_friction_neither_rings_nor_gains_energy(step):
    t = np.linspace(0.0, 2.0, 501)
    model = bench.cart(*dry(level=200.0, breakaway=300.0), mass=0.5)
    run = simulate(model, t, [0.0, 150.0], [0.0, 0.5], position=0.0, velocity=0.5, step=step)
    speeds = np.abs(run.velocity)
    assert np.max(speeds[t < 0.5]) == 0.5
    rested = (t > 0.3) & (t < 0.5)
    assert np.all(speeds[rested] < 1e-9)
    assert np.all(speeds[t > 1.0] < 1e-9)
    assert np.ptp(run.position[t > 1.0]) < 1e-12
