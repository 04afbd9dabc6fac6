# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Switching terms against their closed forms, on s' = d - term."""

import math

import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.switching import SuperTwisting, Surface, boundary_layer

MASS = 20.0
DT = 1e-4


def reached(s, gains, disturbance):
    """Return the time at which s comes into the boundary layer under a constant force in N."""
    k, width = gains.switching_gain(MASS), gains.boundary_width(MASS)
    t = 0.0
    while abs(s) > width:
        s += DT * (disturbance / MASS - boundary_layer(s, gains.bandwidth, k))
        t += DT
    return t


@pytest.mark.parametrize('disturbance', [0.0, 60.0, -60.0])
@pytest.mark.parametrize('start', [2.0, -2.0])
def test_the_layer_is_reached_in_the_time_of_the_reaching_condition(start, disturbance):
    gains = Gains(disturbance_bound=200.0)
    way = abs(start) - gains.boundary_width(MASS)
    helps = -math.copysign(1.0, start) * disturbance
    expected = way * MASS / (gains.disturbance_bound + helps)
    assert reached(start, gains, disturbance) == pytest.approx(expected, abs=2 * DT)
    worst = abs(start) * MASS / (gains.disturbance_bound - abs(disturbance))
    assert reached(start, gains, disturbance) <= worst


def test_within_the_layer_the_variable_decays_at_the_bandwidth():
    gains = Gains(bandwidth=14.0)
    s, t = 0.5 * gains.boundary_width(MASS), 0.0
    first = s
    while t < 0.2:
        s -= DT * boundary_layer(s, gains.bandwidth, gains.switching_gain(MASS))
        t += DT
    assert s == pytest.approx(first * math.exp(-14.0 * t), rel=2e-3)


def test_the_layer_is_never_left_under_the_largest_disturbance():
    gains = Gains(disturbance_bound=100.0)
    s, largest = 0.0, 0.0
    for n in range(40_000):
        d = math.copysign(gains.disturbance_bound, math.sin(2.0 * math.pi * 0.7 * n * DT))
        s += DT * (d / MASS - boundary_layer(s, gains.bandwidth, gains.switching_gain(MASS)))
        largest = max(largest, abs(s))
    assert largest <= gains.boundary_width(MASS) * (1.0 + 1e-9)
    assert largest > 0.9 * gains.boundary_width(MASS)


def test_super_twisting_converges_in_finite_time_and_finds_a_disturbance_that_moves():
    gains = Gains(switching='super_twisting', disturbance_rate=100.0)
    twisting, s, late = SuperTwisting(), 0.3, []
    dt = 2e-3
    for n in range(4000):
        t = n * dt
        d = 1.5 + 4.0 * math.sin(1.1 * t)  # m/s^2; its rate stays below 100 N/s / 20 kg = 5 m/s^3
        term = twisting.step(s, dt, *gains.super_twisting(MASS))
        s += dt * (d - term)
        if t > 4.0:
            late.append((abs(s), abs(term - d)))
    worst_s, worst_d = (max(column) for column in zip(*late, strict=True))
    # What the disturbance changes within one period is left, and no chatter.
    assert worst_s < 2.0 * 5.0 * dt * dt
    assert worst_d < 2.0 * 5.0 * dt


def test_super_twisting_is_zero_at_rest():
    twisting = SuperTwisting()
    assert [twisting.step(0.0, 2e-3, 3.0, 5.0) for _ in range(5)] == [0.0] * 5


def test_a_change_of_bandwidth_leaves_what_the_integral_stands_for():
    surface = Surface()
    surface.integral = 0.03
    assert surface.drive(0.0, 10.0, 50.0) == pytest.approx(10.0 * 0.03)
    assert surface.drive(0.0, 4.0, 50.0) == pytest.approx(10.0 * 0.03)
    assert surface.value == pytest.approx(0.075)
    assert surface.drive(0.01, 4.0, 50.0) == pytest.approx(4.0 * 0.085)
    surface.start()
    assert surface.drive(0.01, 4.0, 50.0) == pytest.approx(0.04)


def test_a_surface_twists_as_the_algorithm_does_and_forgets_with_it():
    surface, alone = Surface(), SuperTwisting()
    surface.integral = 0.02
    for rate in (0.1, 0.05, -0.01):
        assert surface.twist(rate, 2e-3, 3.0, 5.0) == alone.step(rate + 0.02, 2e-3, 3.0, 5.0)
    surface.start()
    assert surface.twist(0.1, 2e-3, 3.0, 5.0) == SuperTwisting().step(0.1, 2e-3, 3.0, 5.0)


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_the_integral_does_not_grow_beyond_the_boundary_layer(sign):
    surface = Surface()
    for _ in range(10_000):
        surface.drive(0.0, 14.0, 10.0)
        surface.integrate(sign * 0.01, 0.0)
    width = 10.0 / 14.0
    assert abs(surface.integral) == pytest.approx(width, abs=0.021)
    surface.drive(0.0, 14.0, 10.0)
    surface.integrate(-sign * 0.1, 0.0)  # back it may go
    assert abs(surface.integral) < width - 0.05


def test_the_integral_does_not_grow_while_the_limits_cut_the_effort():
    surface = Surface()
    surface.drive(0.0, 14.0, 10.0)
    surface.integrate(0.1, 3.0)
    assert surface.integral == 0.0
    surface.integrate(0.1, -3.0)
    assert surface.integral == 0.1


def test_the_integral_of_super_twisting_does_not_grow_while_the_limits_cut_the_effort():
    surface = Surface()
    free = [surface.twist(0.1, 2e-3, 1.0, 50.0) for _ in range(100)]
    surface.start()
    cut = [surface.twist(0.1, 2e-3, 1.0, 50.0, cut=3.0) for _ in range(100)]
    assert free[-1] > free[0] + 5.0
    assert cut[-1] == cut[0]
