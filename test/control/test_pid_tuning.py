# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The baseline's gains against the rule that they were found by, see ``PidGains``.

The loops are linear here: the load on its spring, at places within the reach; a valve with the
mean lag of the benchmark; a sample and a half of delay. Everything is evaluated from the frequency
response, but for the error, which a discrete model of the same loop runs through.
"""

from dataclasses import replace
from functools import cache
from math import exp, radians
from typing import NamedTuple

import numpy as np
import pytest
from scipy.linalg import expm

from pam_ros.control.co_contraction import CoContraction
from pam_ros.control.pid import PidGains
from pam_ros.rig.joint import Joint
from support import closed_loop, pair_loop

DT = 2e-3  # s
LAG, DEAD = 0.060, 0.010  # s
NOMINAL_PEAK, WORST_PEAK, MOST_NOISE = 1.6, 2.0, 400.0  # of the sensitivity; Pa
S = 1j * np.geomspace(0.3, 1500.0, 900)


@cache
def numbers(joint, place, payload=0.0):
    """Return inertia, damping, stiffness, and effort per pressure, with the default stiffness."""
    stiffness = CoContraction().wanted(closed_loop.shared(joint))
    load = replace(joint.load, mass=joint.load.mass + payload)
    allocation = closed_loop.shared(replace(joint, load=load))
    model = allocation.model
    p = allocation.split(model.gravity(place), stiffness, place).pressures
    k = model.stiffness(p, place) + model.gravity_stiffness(place)
    # What the law wants is given to one muscle and taken from the other.
    gain = sum(map(abs, allocation.gains(place)))
    return model.inertia, model.damping(p, place, 0.0), k, gain


class Bench(NamedTuple):
    """What the gains are for, in m and N, or rad and N m: loads at rest, noise of the sensor."""

    gains: PidGains
    joint: Joint
    noise: float
    places: tuple[float, ...]
    payload: float  # kg
    upset: float


ANGLES = (0.0, 0.2, 0.4, 0.6, 0.8)  # rad
BENCHES = {
    'one muscle': Bench(
        *(PidGains(), closed_loop.nominal(), 20e-6),
        *((0.045, 0.055, 0.065, 0.075, 0.085), 5.0, 50.0),
    ),
    'pair': Bench(PidGains.revolute(), pair_loop.nominal(), radians(0.02), ANGLES, 0.3, 2.0),
}
BY_BENCH = pytest.mark.parametrize('bench', BENCHES.values(), ids=BENCHES)
NAMES = ('proportional', 'integral', 'derivative', 'filter_bandwidth')


def of(gains):
    return tuple(getattr(gains, name) for name in NAMES)


def peak(bench, gains, place, payload=0.0, lag=0.0, dead=0.0):
    """Return the largest sensitivity: 1 over the distance of the loop from instability."""
    m, c, k, g = numbers(bench.joint, place, payload)
    plant = g / (m * S**2 + c * S + k) / (lag * S + 1.0) * np.exp(-S * (dead + 1.5 * DT))
    kp, ki, kd, a = of(gains)
    law = (kp + ki / S + kd * S) * (a / (S + a)) ** 2
    return float(np.max(1.0 / np.abs(1.0 + law * plant)))


def noise(bench, gains):
    """Return the standard deviation of the pressure in Pa that the sensor's noise makes."""
    kp, _, kd, a = of(gains)
    z = np.exp(1j * np.linspace(0.01, np.pi, 800))
    share = 1.0 - exp(-a * DT)
    law = (kp + kd * (1.0 - 1.0 / z) / DT) * (share / (1.0 - (1.0 - share) / z)) ** 2
    return bench.noise * float(np.sqrt(np.mean(np.abs(law) ** 2)))


def error_after_upset(bench, gains, place):
    """Return the integral of the absolute error in m s or rad s after the upset, over 3 s."""
    m, c, k, g = numbers(bench.joint, place)
    motion = np.zeros((4, 4))  # of position, velocity, held pressure, held effort
    motion[0, 1], motion[1] = 1.0, (-k / m, -c / m, g / m, 1.0 / m)
    step = expm(motion * DT)
    kp, ki, kd, a = of(gains)
    share = 1.0 - exp(-a * DT)
    x = np.array([0.0, 0.0, 0.0, bench.upset])
    error = filtered = before = integral = waiting = total = 0.0
    for _ in range(1500):
        error += share * (-x[0] - error)
        before, filtered = filtered, filtered + share * (error - filtered)
        integral += ki * filtered * DT
        x[2], waiting = waiting, kp * filtered + integral + kd * (filtered - before) / DT
        x = step @ x
        total += abs(x[0]) * DT
    return total


def is_allowed(bench, gains):
    """Say whether the rule's bounds are kept."""
    others = [
        peak(bench, gains, place, *more)
        for place in bench.places[::2]
        for more in ((bench.payload,), (0.0, LAG), (bench.payload, LAG, DEAD))
    ]
    return (
        max(peak(bench, gains, place) for place in bench.places) <= NOMINAL_PEAK
        and max(others) <= WORST_PEAK
        and noise(bench, gains) <= MOST_NOISE
    )


def worst_error(bench, gains):
    return max(error_after_upset(bench, gains, place) for place in bench.places)


@BY_BENCH
def test_the_bounds_are_kept(bench):
    assert is_allowed(bench, bench.gains)


@BY_BENCH
@pytest.mark.parametrize('seed', range(4))
def test_no_gains_near_by_are_better(bench, seed):
    rng = np.random.default_rng(seed)
    best = worst_error(bench, bench.gains)
    for _ in range(10):
        values = np.array(of(bench.gains)) * rng.uniform(0.8, 1.25, 4)
        other = replace(bench.gains, **dict(zip(NAMES, values.tolist(), strict=True)))
        assert not is_allowed(bench, other) or worst_error(bench, other) > 0.97 * best


def test_the_default_stiffness_can_be_had_at_the_angles_of_the_pair():
    allocation = closed_loop.shared(pair_loop.nominal())
    stiffness = CoContraction().wanted(allocation)
    for place in ANGLES[:-1]:
        low, high = allocation.stiffness_range(place)
        assert low < stiffness < high
    assert allocation.stiffness_range(ANGLES[-1])[0] == pytest.approx(stiffness, rel=0.01)
