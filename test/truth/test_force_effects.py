# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What acts on the load, each effect alone against a closed form or an adaptive solver."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from truth import TruthPlant, effect
from truth.compiled import element
from truth.forces import bend_bristle, friction, stribeck, tendon
from truth.layout import new_state
from truth.muscles import constants_si, static_force

A = constants_si('dmsp_20_400n')
MASS, ZETA, L0, G = 20.0, 0.15, 0.4, 9.81
T = np.arange(0.0, 2.0, 5e-3)


def muscle(p, y, v, mass=MASS):
    """Net force of muscle and weight, written independently."""
    e = math.exp(A[2] * y / L0)
    pull = (A[0] * p + A[1]) * e + A[3] * y / L0 * p + A[4] * p + A[5]
    bracket = (A[0] * p + A[1]) * A[2] * e + A[3] * p
    return pull - 2.0 * ZETA * math.sqrt(-mass * bracket / L0) * v - mass * G


def compare(one, extra, *, mass=MASS, before=200e3, after=400e3, atol=5e-8):
    """Compare a step of pressure on the plant with DOP853 and extra(t, y, v) newtons."""
    plant = TruthPlant(p0=before, effects=[one])
    expected = solve_ivp(
        lambda t, s: [s[1], (muscle(after, s[0], s[1], mass) + extra(t, s[0], s[1])) / mass],
        (T[0], T[-1]),
        [plant.y, 0.0],
        'DOP853',
        T,
        rtol=1e-10,
        atol=1e-12,
        max_step=5e-3,
    )
    got = plant.run(T, np.full(T.size, after))
    np.testing.assert_allclose(got.y, expected.y[0], atol=atol)
    assert np.ptp(got.y) > 0.01
    return got


def test_viscous_friction():
    compare(effect('viscous_friction', viscous_ns_m=120.0), lambda t, y, v: -120.0 * v)


def test_payload_is_a_heavier_load():
    compare(effect('payload', payload_kg=5.0), lambda t, y, v: 0.0, mass=25.0)


def test_pressure_dependent_damping_has_two_directions():
    one = effect(
        'pressure_dependent_damping', damping_up_ns_m_bar=20.0, damping_down_ns_m_bar=60.0
    )
    compare(one, lambda t, y, v: -(20.0 if v > 0 else 60.0) * 4.0 * v, atol=2e-7)


def test_end_stop_of_hunt_and_crossley():
    values = {'stop_m': 0.075, 'stop_n_m15': 2e7, 'stop_s_m': 0.5}

    def stop(t, y, v):
        depth = max(0.0, y - 0.075)
        return -2e7 * depth**1.5 * max(0.0, 1.0 + 0.5 * v)

    got = compare(effect('end_stop', **values), stop, atol=2e-6)
    assert got.y.max() > 0.0755


def test_periodic_force():
    one = effect('periodic_disturbance', 'force', ripple_n=9.0, ripple_hz=3.0, ripple_rad=0.7)
    compare(one, lambda t, y, v: 9.0 * math.sin(6.0 * math.pi * t + 0.7))


def test_quadratic_drag():
    one = effect('quadratic_drag', drag_ns2_m2=1500.0)
    compare(one, lambda t, y, v: -1500.0 * abs(v) * v)


def test_cogging():
    one = effect('cogging', cog_n=10.0, cog_m=0.01)
    compare(one, lambda t, y, v: 10.0 * math.sin(200.0 * math.pi * y))


def test_cross_coupling():
    one = effect('cross_coupling', cross_n_pa=5e-3)
    compare(one, lambda t, y, v: 5e-3 * (y / L0) ** 2 * 400e3)


def test_second_mode_is_two_masses():
    one = effect('second_mode', second_kg=4.0, second_hz=5.0, second_zeta=0.02)
    plant = TruthPlant(p0=200e3, effects=[one])
    k, c = 4.0 * (10.0 * math.pi) ** 2, 2.0 * 0.02 * 10.0 * math.pi * 4.0

    def rhs(t, s):
        y, v, y2, v2 = s
        spring = k * (y2 - y) + c * (v2 - v)  # measured from where the weight has stretched it
        return [v, (muscle(400e3, y, v) + spring) / 16.0, v2, -spring / 4.0]

    expected = solve_ivp(
        rhs, (0.0, T[-1]), [plant.y, 0.0, plant.y, 0.0], 'DOP853', T, rtol=1e-10, atol=1e-12
    )
    got = plant.run(T, np.full(T.size, 400e3))
    np.testing.assert_allclose(got.y, expected.y[0], atol=2e-7)


def test_length_offset_moves_the_position_by_as_much():
    u = 300e3 + 60e3 * np.sin(9.0 * T)
    off = TruthPlant(p0=300e3, effects=[effect('length_offset', kappa_offset=0.01)]).run(T, u)
    np.testing.assert_allclose(off.y + 0.01 * L0, TruthPlant(p0=300e3).run(T, u).y, atol=1e-12)


def test_a_slack_muscle_lets_the_load_fall_freely():
    plant = TruthPlant(mass=3.0, p0=250e3, effects=[effect('slack', 'hard')])
    t = np.arange(0.0, 0.06, 1e-3)
    got = plant.run(t, np.zeros(t.size))
    assert np.all(got.force[1:] == 0.0)
    np.testing.assert_allclose(got.v, -G * t, atol=1e-10)
    np.testing.assert_allclose(got.y, got.y[0] - 0.5 * G * t**2, atol=1e-10)
    pushing = TruthPlant(mass=3.0, p0=250e3).run(t, np.zeros(t.size))
    assert pushing.v[10] < -2.0 * G * t[10]


def test_the_toe_joins_slack_and_pull_smoothly():
    P = TruthPlant(effects=[effect('slack', 'toe', toe_n=20.0)]).parameters
    force = np.linspace(-60.0, 60.0, 12001)
    pull = np.array([tendon(P, f) for f in force])
    assert np.all(pull[force < -20.0] == 0.0)
    np.testing.assert_array_equal(pull[force >= 20.0], force[force >= 20.0])
    assert np.max(np.abs(np.diff(pull, 2))) <= 0.01**2 / (2.0 * 20.0) * 1.001


def test_slip_hysteresis_loop_has_its_area_whatever_the_rate():
    amplitude, reach, swing = 30.0, 4e-3, 20e-3
    one = effect('hysteresis', 'slip', hyst_n=amplitude, hyst_reach_m=reach)
    t = np.arange(0.0, 3.0, 1e-3)
    path = 0.04 + swing * np.interp(t % 1.0, [0.0, 0.25, 0.75, 1.0], [0.0, 1.0, -1.0, 0.0])
    plant = TruthPlant(zeta=0.0, p0=300e3, effects=[one])
    got = plant.run(t, np.full(t.size, 300e3), path)
    static = np.array([static_force(A, 300e3, y / L0) for y in path])
    resist = static - got.force
    # Saturated on both branches, and the loop of an element is 4 f (X - D): the closed form.
    assert resist.max() == pytest.approx(amplitude, rel=5e-3)
    last = slice(1000, 2001)
    area = np.sum(0.5 * (resist[last][1:] + resist[last][:-1]) * np.diff(path[last]))
    reaches = reach * np.geomspace(0.05, 1.0, 12)
    expected = np.sum(4.0 * amplitude / 12 * (swing - reaches))
    assert area == pytest.approx(expected, rel=5e-3)
    slow = TruthPlant(zeta=0.0, p0=300e3, effects=[one]).run(5.0 * t, np.full(t.size, 300e3), path)
    np.testing.assert_allclose(slow.force, got.force, atol=0.2)


def test_minor_loop_returns_to_where_it_left():
    one = effect('hysteresis', 'slip', hyst_n=30.0, hyst_reach_m=8e-3)
    t = np.arange(0.0, 4.0, 1e-3)
    path = 0.03 + np.interp(t, [0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 0.02, 0.015, 0.02, 0.03])
    got = TruthPlant(zeta=0.0, p0=300e3, effects=[one]).run(t, np.full(t.size, 300e3), path)
    direct = np.interp(t, [0.0, 4.0], [0.03, 0.06])
    other = TruthPlant(zeta=0.0, p0=300e3, effects=[one]).run(t, np.full(t.size, 300e3), direct)
    here, there = np.searchsorted(t, 3.5), np.searchsorted(direct, path[3500])
    assert got.force[here] == pytest.approx(other.force[there], abs=0.1)


def test_maxwell_branches_relax_with_two_times():
    values = {'maxwell_1_n_m': 600.0, 'creep_1_s': 0.5, 'maxwell_2_n_m': 300.0, 'creep_2_s': 6.0}
    t = np.arange(0.0, 6.0, 1e-3)
    path = np.where(t < 0.5e-3, 0.04, 0.05)
    plant = TruthPlant(zeta=0.0, p0=300e3, effects=[effect('creep', 'strain', **values)])
    got = plant.run(t, np.full(t.size, 300e3), path)
    missing = 0.01 * (600.0 * np.exp(-t / 0.5) + 300.0 * np.exp(-t / 6.0))
    np.testing.assert_allclose(
        got.force[2:], static_force(A, 300e3, 0.125) - missing[2:], atol=1e-2
    )


def test_bristles_follow_lugre_as_radau_solves_it():
    P = TruthPlant(effects=[effect('coulomb_friction', coulomb_n=15.0, static_n=25.0)]).parameters
    S = element(new_state())

    def level(v):
        return 15.0 + 10.0 * math.exp(-((v / 0.01) ** 2))

    def speed(t):
        return 0.03 * math.sin(2.0 * math.pi * t)

    t = np.linspace(0.0, 1.0, 20001)
    expected = solve_ivp(
        lambda now, z: speed(now) - abs(speed(now)) * z * 1e6 / level(speed(now)),
        (0.0, 1.0),
        [0.0],
        'Radau',
        t,
        rtol=1e-9,
        atol=1e-13,
        max_step=1e-3,
    ).y[0]
    found = [0.0]
    for now, after in pairwise(t):
        bend_bristle(P, S, speed(0.5 * (now + after)), after - now)
        found.append(S.bristle)
    np.testing.assert_allclose(np.array(found) * 1e6, expected * 1e6, atol=0.05)


def test_sliding_friction_is_stribecks_curve():
    P = TruthPlant(effects=[effect('coulomb_friction', coulomb_n=15.0, static_n=25.0)]).parameters
    for v in (-0.2, -0.01, 0.002, 0.01, 0.2):
        S = element(new_state())
        for _ in range(400):
            bend_bristle(P, S, v, 1e-3)
        assert friction(P, S, v) == pytest.approx(math.copysign(stribeck(P, v), v), rel=1e-6)
    assert stribeck(P, 0.0) == pytest.approx(25.0)


@pytest.mark.parametrize(('force', 'slips'), [(22.0, False), (28.0, True)])
def test_a_load_sticks_below_the_static_friction(force, slips):
    # A slow rise of the pressure by as much as gives the force at this length.
    stick = effect('coulomb_friction', coulomb_n=15.0, static_n=25.0)
    plant = TruthPlant(p0=300e3, effects=[stick])
    kappa = plant.y / L0
    slope = static_force(A, 1.0, kappa) - static_force(A, 0.0, kappa)
    t = np.arange(0.0, 4.0, 2e-3)
    got = plant.run(t, 300e3 + np.minimum(t / 3.0, 1.0) * force / slope)
    moved = got.y[-1] - got.y[0]
    assert (moved > 5e-4) == slips
    if not slips:
        # Bristles bend as x = -z ln(1 - f / f_s), z = f_s / stiffness; the muscle gives way 1 %.
        assert moved == pytest.approx(-25e-6 * math.log(1.0 - force / 25.0), rel=0.08)


def test_softening_counts_the_work():
    soft = effect('softening', 'work', soft_share=0.05, soft_work_j=50.0)
    t = np.arange(0.0, 8.0, 2e-3)
    u = 300e3 + 60e3 * np.sin(4.0 * t)
    plant = TruthPlant(p0=300e3, effects=[soft])
    got = plant.run(t, u)
    work = np.sum(np.abs(got.force * got.v)) * 2e-3
    assert plant.state.wear == pytest.approx(work / 50.0, rel=1e-3)
    assert plant.state.wear > 1.0
    kappa, p = got.y[-1] / L0, got.pressure[-1]
    bracket = (A[0] * p + A[1]) * A[2] * math.exp(A[2] * kappa) + A[3] * p
    factor = 1.0 - 0.05 * (1.0 - math.exp(-plant.state.wear))
    damp = 2.0 * ZETA * math.sqrt(-MASS * bracket * factor / L0) * got.v[-1]
    assert got.force[-1] == pytest.approx(factor * static_force(A, p, kappa) - damp, abs=0.05)


def test_temperature_drift_is_a_tanh_in_time():
    drift = effect('temperature_drift', drift_share=0.04, drift_mid_s=1.0, drift_width_s=0.3)
    got = TruthPlant(p0=300e3, effects=[drift]).run(
        T, np.full(T.size, 300e3), np.full(T.size, 0.04)
    )
    expected = static_force(A, 300e3, 0.1) * (1.0 + 0.04 * np.tanh((T - 1.0) / 0.3))
    np.testing.assert_allclose(got.force[1:], expected[1:], atol=5e-3)


def test_backlash_of_the_linkage_is_a_play():
    play = effect('backlash', play_m=0.5e-3)
    u = 300e3 + 60e3 * np.sin(9.0 * T)
    got = TruthPlant(p0=300e3, effects=[play]).run(T, u)
    expected = [got.y[0]]
    for y in got.y[1:]:
        expected.append(min(y + 0.5e-3, max(y - 0.5e-3, expected[-1])))
    np.testing.assert_allclose(got.linked, expected, atol=2e-5)
    assert np.max(np.abs(got.linked - got.y)) == pytest.approx(0.5e-3, abs=1e-9)


@pytest.mark.slow
def test_random_walk_grows_with_the_root_of_time():
    ends = []
    for seed in range(400):
        plant = TruthPlant(effects=[effect('random_walk', walk_n_rs=2.0)], seed=seed)
        ends.append(plant._walk(np.full(100, 0.04))[-1])
    assert np.std(ends) == pytest.approx(4.0, rel=0.12)
