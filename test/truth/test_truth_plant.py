# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The integrator against scipy's adaptive solvers with independently written equations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from truth import FORMS, PROGRAMMES, Sensor, TruthPlant, control_plant, effect
from truth.muscles import constants_si, contraction_for, pressure_for, static_force

A = constants_si('dmsp_20_400n')
MASS, ZETA, L0, G = 20.0, 0.15, 0.4, 9.81


def pull_and_damping(p, y, v, mass=MASS, zeta=ZETA):
    kappa = y / L0
    pull = (A[0] * p + A[1]) * np.exp(A[2] * kappa) + A[3] * kappa * p + A[4] * p + A[5]
    bracket = (A[0] * p + A[1]) * A[2] * np.exp(A[2] * kappa) + A[3] * p
    return pull, 2.0 * zeta * np.sqrt(-mass * bracket / L0) * v


def solve(rhs, state, t, method='DOP853'):
    found = solve_ivp(rhs, (t[0], t[-1]), state, method, t, rtol=1e-11, atol=1e-13)
    assert found.success
    return found.y


def test_constants_reproduce_the_papers_equilibrium():
    kappa = contraction_for(A, 600e3, 20.0 * G)
    assert kappa == pytest.approx(0.243, abs=0.0005)
    assert static_force(A, 600e3, kappa) == pytest.approx(196.2, abs=1e-6)
    assert pressure_for(A, 196.2, kappa) == pytest.approx(600e3, abs=1e-3)


def test_step_of_pressure_matches_dop853():
    plant = TruthPlant(p0=200e3)
    t = np.linspace(0.0, 2.0, 401)

    def rhs(_, s):
        pull, damp = pull_and_damping(400e3, s[0], s[1])
        return [s[1], (pull - damp) / MASS - G]

    expected = solve(rhs, [plant.y, 0.0], t)
    got = plant.run(t, np.full(t.size, 400e3))
    assert np.ptp(expected[0]) > 0.03
    np.testing.assert_allclose(got.y, expected[0], atol=2e-8)
    np.testing.assert_allclose(got.v, expected[1], atol=1e-6)


@pytest.mark.parametrize(('before', 'after', 'tau'), [(2e5, 4e5, 0.05), (4e5, 2e5, 0.07)])
def test_fill_and_vent_have_their_own_time(before, after, tau):
    plant = TruthPlant(p0=before, effects=[effect('pressure_lag', fill_s=0.05, vent_s=0.07)])
    t = np.linspace(0.0, 1.0, 201)

    def course(now):
        return after + (before - after) * np.exp(-now / tau)

    def rhs(now, s):
        pull, damp = pull_and_damping(course(now), s[0], s[1])
        return [s[1], (pull - damp) / MASS - G]

    expected = solve(rhs, [plant.y, 0.0], t)
    got = plant.run(t, np.full(t.size, after))
    np.testing.assert_allclose(
        got.pressure, after + (before - after) * np.exp(-t / tau), atol=1e-3
    )
    np.testing.assert_allclose(got.y, expected[0], atol=2e-8)


def test_error_falls_fourfold_when_the_step_is_halved():
    t = np.linspace(0.0, 1.0, 101)
    u = np.full(t.size, 400e3)
    lag = [effect('pressure_lag')]
    runs = [TruthPlant(p0=200e3, effects=lag, dt=dt).run(t, u).y for dt in (4e-4, 2e-4, 1e-4)]
    ratio = np.max(np.abs(runs[0] - runs[1])) / np.max(np.abs(runs[1] - runs[2]))
    assert ratio == pytest.approx(4.0, rel=0.05)


@pytest.mark.parametrize('name', ['hysteresis', 'friction', 'all'])
def test_benchmark_plants_have_converged(name):
    t = np.arange(0.0, 4.0, 2e-3)
    u = 300e3 + 60e3 * np.sin(2.0 * np.pi * 0.5 * t) + np.where(t > 2.0, 50e3, 0.0)
    coarse = control_plant(name)
    fine = control_plant(name)
    fine.parameters.dt = coarse.parameters.dt / 8.0
    difference = coarse.run(t, u).y - fine.run(t, u).y
    assert np.max(np.abs(difference)) < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize(('kind', 'form'), [key for key in FORMS if key[0] != 'random_walk'])
def test_every_effect_has_converged_far_below_the_noise(kind, form):
    t = np.arange(0.0, 6.0, 5e-3)
    u = PROGRAMMES['mixture'](200.0, 6.0, 150e3, 350e3, np.random.default_rng(3))
    runs = []
    for dt in (5e-5, 5e-5 / 8.0):
        plant = TruthPlant(effects=[effect(kind, form)], p0=u[0], dt=dt)
        runs.append(plant.run(t, u).linked)
    assert np.max(np.abs(runs[0] - runs[1])) < 1e-7


def test_stepping_and_running_are_the_same_bits():
    t = np.arange(0.0, 1.0, 2e-3)
    u = 300e3 + 60e3 * np.sin(2.0 * np.pi * t)
    stepped, ran = control_plant('all'), control_plant('all')
    true = []
    for now, command in zip(t, u, strict=True):
        assert stepped.t == pytest.approx(now, abs=1e-12)
        true.append(stepped.y)
        stepped.step(command, 2e-3)
    np.testing.assert_allclose(ran.run(t, u).y, true, rtol=0.0, atol=1e-13)


def test_sensor_noise_has_its_spread_and_colour():
    for rho in (0.0, 0.9):
        one = Sensor(noise=20e-6, rho=rho)
        one.reset(3)
        noise = np.array([one.read(0.0, 0.05) for _ in range(40_000)]) - 0.05
        assert noise.std() == pytest.approx(20e-6, rel=0.05)
        assert np.corrcoef(noise[1:], noise[:-1])[0, 1] == pytest.approx(rho, abs=0.02)


def test_sensor_reads_late_and_in_steps():
    one = Sensor(latency=3e-3, quantum=1e-5, offset=1e-3)
    readings = [one.read(k * 2e-3, k * 1e-3) for k in range(10)]
    assert readings[9] == pytest.approx(9e-3 - 1.5e-3 + 1e-3, abs=1e-12)
    t = np.arange(10) * 2e-3
    one.reset(0)
    np.testing.assert_allclose(one.read_all(t, np.arange(10) * 1e-3), readings, atol=1e-12)
