# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What happens to the pressure, each effect alone against a closed form or an adaptive solver."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from truth import TruthPlant, effect
from truth.muscles import constants_si, static_force

A = constants_si('dmsp_20_400n')
T = np.arange(0.0, 2.0, 1e-3)


def held(effects, t, u, kappa=0.1, p0=200e3):
    plant = TruthPlant(effects=effects, p0=p0)
    return plant.run(t, u, np.full(t.size, kappa * 0.4))


def test_dead_time_moves_the_answer_and_nothing_else():
    u = 300e3 + 50e3 * np.sin(7.0 * T)
    prompt = TruthPlant(p0=300e3).run(T, u)
    late = TruthPlant(p0=300e3, effects=[effect('dead_time', dead_time_s=0.012)]).run(T, u)
    assert np.ptp(late.y[:13]) < 1e-12
    np.testing.assert_allclose(late.y[12:], prompt.y[:-12], atol=1e-12)


def test_regulator_is_affine():
    u = 300e3 + 50e3 * np.sin(7.0 * T)
    off = effect('pressure_offset', regulator_pa=5e3, regulator_gain=0.98)
    got = TruthPlant(p0=300e3, effects=[off]).run(T, u)
    expected = TruthPlant(p0=0.98 * 300e3 + 5e3).run(T, 0.98 * u + 5e3)
    np.testing.assert_allclose(got.y, expected.y, atol=1e-12)


def test_a_valve_with_overlap_gives_nothing_below_it():
    u = 100e3 + 100e3 * np.sin(7.0 * T)
    got = TruthPlant(p0=100e3, effects=[effect('dead_band', 'overlap', overlap_pa=6e4)]).run(T, u)
    expected = TruthPlant(p0=4e4).run(T, np.maximum(u - 6e4, 0.0))
    np.testing.assert_allclose(got.y, expected.y, atol=1e-12)
    np.testing.assert_allclose(got.pressure, expected.pressure, atol=1e-9)


def test_a_bladder_takes_its_pressure_from_the_chamber():
    u = 100e3 + 100e3 * np.sin(7.0 * T)
    band = effect('dead_band', 'bladder', bladder_pa=6e4)
    got = held([band], T, u, p0=u[0])
    np.testing.assert_allclose(got.pressure[1:], u[:-1])  # the sensor sees all of it
    inside = np.maximum(u[:-1] - 6e4, 0.0)
    np.testing.assert_allclose(got.force[1:], [static_force(A, p, 0.1) for p in inside])


def iso_6358(p, target, c_fill, c_vent, volume, band):
    """dp/dt, independently: n C p1 psi(p2/p1) p_ref / V, absolute pressures, litres and bar."""
    opening = np.clip((target - p) / band, -1.0, 1.0)
    up, down, c = (9.013e5, p + 1.013e5, c_fill) if opening > 0 else (p + 1.013e5, 1.013e5, c_vent)
    psi = np.sqrt(1.0 - (max(down / up - 0.3, 0.0) / 0.7) ** 2)
    return opening * 1.2 * c * up * psi / volume


@pytest.mark.parametrize(('p0', 'target'), [(100e3, 500e3), (500e3, 100e3)])
def test_iso_6358_flow_matches_radau(p0, target):
    values = {'conductance_fill': 0.8, 'conductance_vent': 0.5, 'volume_l': 0.2}
    flow = effect('pressure_lag', 'iso_6358', **values, valve_band_pa=60e3)
    t = np.arange(0.0, 0.4, 1e-3)
    expected = solve_ivp(
        lambda _, s: [iso_6358(s[0], target, 0.8, 0.5, 0.2, 60e3)],
        (0.0, t[-1]),
        [p0],
        'Radau',
        t,
        rtol=1e-9,
    ).y[0]
    got = held([flow], t, np.full(t.size, target), p0=p0)
    np.testing.assert_allclose(got.pressure, expected, atol=2.0)
    assert abs(got.pressure[-1] - target) < 0.05 * abs(p0 - target)


def test_choked_fill_climbs_at_the_rate_of_its_conductance():
    flow = effect('pressure_lag', 'iso_6358', conductance_fill=0.5, volume_l=0.2)
    t = np.arange(0.0, 0.02, 1e-3)
    got = held([flow], t, np.full(t.size, 500e3), p0=50e3)
    np.testing.assert_allclose(np.diff(got.pressure), 1.2 * 0.5 * 9.013e5 / 0.2 * 1e-3, rtol=1e-9)


def test_closed_valve_loses_pressure_until_the_next_command():
    leak = effect('leak', 'closed_valve', leak_per_s=0.1, valve_open_s=0.2)
    u = np.where(T < 1.0, 400e3, 300e3)
    got = held([leak], T, u, p0=400e3)
    closed = np.maximum(T % 1.0 - 0.2, 0.0)
    # The sample at 1 s is taken before the new command acts.
    expected = np.where(T <= 1.0, 400e3, 300e3) * np.exp(-0.1 * np.where(T == 1.0, 0.8, closed))
    np.testing.assert_allclose(got.pressure, expected, rtol=1e-5)


def test_leak_against_a_limited_refill():
    leak = effect('leak', 'refill', leak_per_s=0.5, fill_s=0.1, refill_pa_s=8e5)
    got = held([leak], T, np.full(T.size, 500e3), p0=100e3)
    expected = solve_ivp(
        lambda _, s: (
            [np.clip((500e3 - s[0]) / 0.1, -8e5, 8e5) - 0.5 * s[0]] if s[0] < 500e3 else [0.0]
        ),
        (0.0, T[-1]),
        [100e3 / 1.05],
        t_eval=T,
        rtol=1e-9,
        max_step=1e-3,
    ).y[0]
    np.testing.assert_allclose(got.pressure, expected, atol=5.0)
    assert got.pressure[-1] == pytest.approx(500e3 / 1.05, rel=1e-6)


def test_a_leak_is_there_after_a_fall_of_the_command_too():
    leak = effect('leak', 'refill', leak_per_s=0.5, fill_s=0.1, vent_s=0.02, refill_pa_s=8e5)
    got = held([leak], T, np.where(T < 0.5, 500e3, 300e3), p0=500e3)
    assert got.pressure[-1] == pytest.approx(300e3 / 1.05, rel=1e-4)


def test_supply_ripple_is_in_the_pressure():
    ripple = effect('periodic_disturbance', 'supply', ripple_pa=3e3, ripple_hz=2.5, ripple_rad=0.4)
    got = held([ripple], T, np.full(T.size, 300e3))
    expected = 300e3 + 3e3 * np.sin(2.0 * np.pi * 2.5 * T + 0.4)
    np.testing.assert_allclose(got.pressure[1:], expected[1:], atol=1e-6)


def test_creep_in_the_pressure_has_two_times():
    late = effect('creep', 'pressure', late_1=0.03, creep_1_s=0.2, late_2=0.02, creep_2_s=5.0)
    got = held([late], T, np.full(T.size, 400e3), p0=200e3)
    missing = 200e3 * (0.03 * np.exp(-T / 0.2) + 0.02 * np.exp(-T / 5.0))
    expected = [static_force(A, 400e3 - m, 0.1) for m in missing]
    np.testing.assert_allclose(got.force[1:], expected[1:], atol=2e-2)


def test_creep_in_the_force_has_two_times():
    late = effect('creep', 'force', creep_1=0.03, creep_1_s=0.2, creep_2=0.02, creep_2_s=5.0)
    got = held([late], T, np.full(T.size, 400e3), p0=200e3)
    high, low = static_force(A, 400e3, 0.1), static_force(A, 200e3, 0.1)
    missing = (high - low) * (0.03 * np.exp(-T / 0.2) + 0.02 * np.exp(-T / 5.0))
    np.testing.assert_allclose(got.force[1:], (high - missing)[1:], atol=2e-2)


def test_pressure_hysteresis_has_its_width_and_no_rate():
    amplitude = 8e3
    slip = effect('hysteresis', 'pressure', hyst_pa=amplitude, hyst_reach_pa=40e3)
    swing = np.interp(T, [0.0, 0.5, 1.0, 1.5, 2.0], [200e3, 500e3, 200e3, 500e3, 200e3])
    force = held([slip], T, swing).force
    slope = static_force(A, 1.0, 0.1) - static_force(A, 0.0, 0.1)
    up, down = force[1350], force[1650]  # the second branches at 410 kPa
    width = (static_force(A, swing[1349], 0.1) - up) / slope
    assert width == pytest.approx(amplitude, rel=1e-3)
    width = (down - static_force(A, swing[1649], 0.1)) / slope
    assert width == pytest.approx(amplitude, rel=1e-3)
    slow = held([slip], 10.0 * T, swing).force
    np.testing.assert_allclose(slow, force, atol=1e-6)


def test_a_regulator_with_a_dead_zone_follows_at_its_distance():
    # Prandtl's play, from its definition: sample by sample, the nearest value in the zone.
    u = 300e3 + 20e3 * np.sin(9.0 * T) * T + 3e3 * np.sin(50.0 * T)
    expected = [u[0]]
    for one in u[:-1]:
        expected.append(float(np.clip(expected[-1], one - 6e3, one + 6e3)))
    zone = effect('regulator_dead_zone', 'play', dead_zone_pa=6e3)
    np.testing.assert_allclose(held([zone], T, u, p0=300e3).pressure, expected, atol=1e-6)


def test_a_slow_regulator_stops_at_the_edge_of_its_dead_zone():
    u = np.where(T < 1.0, 350e3, 250e3)
    zone = effect('regulator_dead_zone', 'play', dead_zone_pa=10e3)
    lag = effect('pressure_lag', 'two_times', fill_s=0.05, vent_s=0.05)
    pressure = held([zone, lag], T, u).pressure
    assert pressure[990] == pytest.approx(340e3, abs=1.0)
    assert pressure[-1] == pytest.approx(260e3, abs=1.0)


def test_softening_counts_pressure_cycles():
    soft = effect('softening', 'cycles', soft_share=0.05, soft_path_pa=2e6)
    t = np.arange(0.0, 20.0, 5e-3)
    swing = 300e3 + 100e3 * np.interp(t % 1.0, [0.0, 0.25, 0.75, 1.0], [0.0, 1.0, -1.0, 0.0])
    got = held([soft], t, swing, p0=300e3)
    for cycle in (1, 5, 15):
        k = 200 * cycle
        path = 4e5 * cycle
        factor = 1.0 - 0.05 * (1.0 - np.exp(-path / 2e6))
        p = swing[k - 1]
        assert got.force[k] == pytest.approx(factor * static_force(A, p, 0.1), rel=2e-4)


def test_saturation_takes_its_share_of_the_gain_above_the_knee():
    knee = effect('saturation', saturation=0.3, knee_pa=300e3)
    high, higher = (held([knee], T[:100], np.full(100, p), p0=p).force[-1] for p in (500e3, 600e3))
    slope = static_force(A, 1.0, 0.1) - static_force(A, 0.0, 0.1)
    assert (higher - high) / (slope * 1e5) == pytest.approx(0.7, abs=2e-3)
