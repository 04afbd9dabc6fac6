# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The baseline's gains against the rule that they were found by, see ``PidGains``.

The loop is linear here: the load on its spring, at places within the reach; a valve with the mean
lag of the benchmark; a sample and a half of delay. Everything is evaluated from the frequency
response, but for the error, which a discrete model of the same loop runs through.
"""

from dataclasses import astuple
from math import exp

import numpy as np
import pytest
from pam_ros.control.inner_model import InnerModel
from scipy.linalg import expm

from pam_ros.control.pid import PidGains
from support.closed_loop import declared

DT = 2e-3  # s
NOISE = 20e-6  # m
PLACES = (0.045, 0.055, 0.065, 0.075, 0.085)  # m
PAYLOAD, LAG, DEAD = 5.0, 0.060, 0.010  # kg, s, s
NOMINAL_PEAK, WORST_PEAK, MOST_NOISE = 1.6, 2.0, 400.0  # of the sensitivity; Pa
UPSET = 50.0  # N
S = 1j * np.geomspace(0.3, 1500.0, 900)


def numbers(place, payload=0.0):
    """Return m, c, k and the gain of the load that rests at a place."""
    rig = InnerModel(declared())
    mass = rig.mass + payload
    p = rig.pressure_for(mass * rig.weight / rig.mass, place)
    return mass, rig.damping(p, place, 0.0), rig.stiffness(p, place), rig.gain(place)


def peak(gains, place, payload=0.0, lag=0.0, dead=0.0):
    """Return the largest sensitivity: 1 over the distance of the loop from instability."""
    m, c, k, g = numbers(place, payload)
    plant = g / (m * S**2 + c * S + k) / (lag * S + 1.0) * np.exp(-S * (dead + 1.5 * DT))
    kp, ki, kd, a = astuple(gains)
    law = (kp + ki / S + kd * S) * (a / (S + a)) ** 2
    return float(np.max(1.0 / np.abs(1.0 + law * plant)))


def noise(gains):
    """Return the standard deviation of the pressure in Pa that the sensor's noise makes."""
    kp, _, kd, a = astuple(gains)
    z = np.exp(1j * np.linspace(0.01, np.pi, 800))
    share = 1.0 - exp(-a * DT)
    law = (kp + kd * (1.0 - 1.0 / z) / DT) * (share / (1.0 - (1.0 - share) / z)) ** 2
    return NOISE * float(np.sqrt(np.mean(np.abs(law) ** 2)))


def upset(gains, place):
    """Return the integral of the absolute error in m s after UPSET N, over 3 s."""
    m, c, k, g = numbers(place)
    motion = np.zeros((4, 4))  # of position, velocity, held pressure, held force
    motion[0, 1], motion[1] = 1.0, (-k / m, -c / m, g / m, 1.0 / m)
    step = expm(motion * DT)
    kp, ki, kd, a = astuple(gains)
    share = 1.0 - exp(-a * DT)
    x = np.array([0.0, 0.0, 0.0, UPSET])
    error = filtered = before = integral = waiting = total = 0.0
    for _ in range(1500):
        error += share * (-x[0] - error)
        before, filtered = filtered, filtered + share * (error - filtered)
        integral += ki * filtered * DT
        x[2], waiting = waiting, kp * filtered + integral + kd * (filtered - before) / DT
        x = step @ x
        total += abs(x[0]) * DT
    return total


def is_allowed(gains, slack=1.0):
    """Say whether the rule's bounds are kept."""
    others = [
        peak(gains, place, *more)
        for place in PLACES[::2]
        for more in ((PAYLOAD,), (0.0, LAG), (PAYLOAD, LAG, DEAD))
    ]
    return (
        max(peak(gains, place) for place in PLACES) <= NOMINAL_PEAK * slack
        and max(others) <= WORST_PEAK * slack
        and noise(gains) <= MOST_NOISE * slack
    )


def worst_upset(gains):
    return max(upset(gains, place) for place in PLACES)


def test_the_bounds_are_kept():
    assert is_allowed(PidGains())


@pytest.mark.parametrize('seed', range(4))
def test_no_gains_near_by_are_better(seed):
    rng = np.random.default_rng(seed)
    best = worst_upset(PidGains())
    for _ in range(10):
        other = PidGains(*(np.array(astuple(PidGains())) * rng.uniform(0.8, 1.25, 4)))
        assert not is_allowed(other) or worst_upset(other) > 0.97 * best
