# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The switching term against closed forms, on s' = d - term."""

import math

import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.switching import Surface, boundary_layer

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


def test_a_change_of_bandwidth_leaves_what_the_integral_stands_for():
    surface = Surface()
    surface.integral = 0.03
    assert surface.drive(0.0, 10.0, 50.0) == pytest.approx(10.0 * 0.03)
    assert surface.drive(0.0, 4.0, 50.0) == pytest.approx(10.0 * 0.03)
    assert surface.value == pytest.approx(0.075)
    assert surface.drive(0.01, 4.0, 50.0) == pytest.approx(4.0 * 0.085)
    surface.start()
    assert surface.drive(0.01, 4.0, 50.0) == pytest.approx(0.04)


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
