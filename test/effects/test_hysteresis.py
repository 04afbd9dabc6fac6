# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Hysteresis against the differential equation of Dahl and the play operators of Prandtl."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp, trapezoid

from pam_ros.effects.hysteresis import Hysteresis
from pam_ros.effects.maxwell_slip import ELEMENTS
from pam_ros.rig.run import simulate, simulate_held
from support import bench

TURNS = np.array([0.05, 0.12, 0.08, 0.1, 0.03, 0.15, 0.149, 0.15, 0.0, 0.06])  # of contraction
DAHL = {'amplitude': 12.0, 'width': 0.02}
SLIP = {'slip': 9.0, 'slip_width': 0.05, 'slip_onset': 0.1}


def path(turns=TURNS, points=50):
    """Return contractions along straight ways between turns, *points* a way."""
    return np.interp(np.arange((len(turns) - 1) * points + 1) / points, range(len(turns)), turns)


def loop(effect, kappa):
    """Return the force that hysteresis adds along a path of contraction."""
    p = np.full(kappa.shape, 3e5)
    t, y, still = np.arange(float(kappa.size)), kappa * bench.L0, np.zeros(kappa.size)
    with_it = simulate_held(bench.hanging(Hysteresis(**effect)), t, p, y, still, step=1.0).force
    return with_it - simulate_held(bench.hanging(), t, p, y, still, step=1.0).force


def test_dahls_loops_against_their_differential_equation():
    width, z, expected = DAHL['width'], 0.0, [0.0]
    for a, b in pairwise(TURNS):
        speed = b - a

        def rhs(_, z, speed=speed):
            return (speed - abs(speed) * z) / width

        run = solve_ivp(rhs, (0.0, 1.0), [z], rtol=1e-10, atol=1e-12, max_step=0.01)
        z = run.y[0, -1]
        expected.append(-DAHL['amplitude'] * z)
    force = loop(DAHL, path())
    np.testing.assert_allclose(force[::50], expected, atol=1e-7)


@pytest.mark.parametrize(('onset', 'ratio'), [(0.0, 1.0), (0.3, 1.0), (1.0, 4.0), (0.1, 25.0)])
def test_maxwell_slip_is_the_complement_of_prandtls_plays(onset, ratio):
    kappa = path()
    # Quantiles of the radii: with a ratio r, (r^s - 1) / (r - 1) between the onset and 1.
    s = (np.arange(ELEMENTS) + 0.5) / ELEMENTS
    share = s if ratio == 1.0 else (ratio**s - 1.0) / (ratio - 1.0)
    radii = SLIP['slip_width'] * (onset + (1.0 - onset) * share)
    play, expected = np.full(ELEMENTS, kappa[0]), []
    for k in kappa:
        play = np.maximum(k - radii, np.minimum(k + radii, play))
        expected.append(-SLIP['slip'] * np.mean((k - play) / radii))
    force = loop({**SLIP, 'slip_onset': onset, 'slip_ratio': ratio}, kappa)
    np.testing.assert_allclose(force, expected, atol=1e-9)


@pytest.mark.parametrize('effect', [DAHL, SLIP, {**DAHL, **SLIP}])
def test_only_the_displacement_counts_neither_speed_nor_sampling(effect):
    fine, coarse = loop(effect, path(points=100)), loop(effect, path(points=1))
    np.testing.assert_allclose(fine[::100], coarse, atol=1e-10)


def test_maxwell_slip_closes_minor_loops_and_forgets_them():
    straight = loop(SLIP, path([0.0, 0.08, 0.1]))
    with_loop = loop(SLIP, path([0.0, 0.08, 0.06, 0.07, 0.06, 0.08, 0.1]))
    np.testing.assert_allclose(with_loop[-50:], straight[-50:], atol=1e-10)


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize('effect', [DAHL, SLIP])
@given(turns=st.lists(st.floats(-0.03, 0.2), min_size=1, max_size=8))
def test_a_path_repeated_never_gains_work(effect, turns):
    once = [0.05, *turns, 0.05]
    kappa = path(np.array(3 * once))
    last = slice(-50 * (len(once) - 1) - 1, None)
    assert trapezoid(loop(effect, kappa)[last], kappa[last]) <= 1e-9


def test_load_on_a_muscle_with_hysteresis_against_an_adaptive_solver():
    t = np.linspace(0.0, 1.5, 151)
    commands = ((0.0, 2.5e5), (0.2, 3.5e5), (0.8, 3e5))
    run = simulate(bench.hanging(Hysteresis(**DAHL)), t, **bench.stepped(commands))
    state, y = np.array([bench.rest(2.5e5), 0.0, 0.0]), []
    ends = [0.2, 0.8, 1.5]
    for (begin, u), end in zip(commands, ends, strict=True):

        def rhs(_, state, u=u):
            y, v, z = state
            rate = v / bench.L0
            dz = (rate - abs(rate) * z) / DAHL['width']
            net = bench.pull(u, y) - DAHL['amplitude'] * z - bench.drag(u, y) * v
            return v, net / bench.MASS - bench.G, dz

        inside = t[(t >= begin) & (t < end)] if end < 1.5 else t[t >= begin]
        solution = solve_ivp(
            rhs, (begin, end), state, rtol=1e-10, atol=1e-12, max_step=1e-3, dense_output=True
        )
        y += list(solution.sol(inside)[0])
        state = solution.y[:, -1]
    np.testing.assert_allclose(run.position, y, atol=1e-6)
    assert np.ptp(y) > 0.01


@pytest.mark.parametrize('effect', [DAHL, SLIP, {**SLIP, 'slip_ratio': 10.0}])
@pytest.mark.parametrize('side', [1.0, -1.0])
def test_loops_can_start_as_a_long_motion_has_left_them(effect, side):
    far = np.linspace(0.15 - side * 0.22, 0.15 + side * 0.22, 401)
    back = np.linspace(0.15 + side * 0.22, 0.15, 51)
    come = loop(effect, np.concatenate([far, back]))[401:]
    put = loop({**effect, 'initial': side}, back)
    np.testing.assert_allclose(put, come, atol=1e-6)


def test_every_start_is_allowed():
    for start in Hysteresis.fit_starts():
        assert Hysteresis(**start).is_present
