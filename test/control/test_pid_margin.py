# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The share of PID gains that a joint bears, against the poles of a loop of its own equations."""

import numpy as np
import pytest

from pam_ros.control.pid_margin import TUNING, LinearPlant, Share, share

GAINS = (49.1e3, 1.91e6, 9.09e3, 326.0)  # of a joint that turns: Pa/rad ..., rad/s
PAIR = LinearPlant(0.0825, 0.463, 31.3, 1.67e-4)
CRANK = LinearPlant(0.0825, 0.207, 8.26, 8.5e-5)


def rightmost(plant, part, lag):
    """Return the largest real part of the poles, the delay as one more lag of its length."""
    j, c, k, g = plant
    kp, ki, kd, a = GAINS
    opened = np.polymul([j, c, k], np.polymul([lag, 1.0], [TUNING.delay, 1.0]))
    opened = np.polymul(np.polymul(opened, [1.0, 0.0]), np.polymul([1 / a, 1.0], [1 / a, 1.0]))
    law = part.all * g * np.array([kd, kp, part.integral * ki])
    return np.max(np.roots(np.polyadd(opened, law)).real)


def peak(plant, part, lag):
    """Return the largest sensitivity, at frequencies of its own."""
    x = 1j * np.geomspace(0.5, 300.0, 997)
    kp, ki, kd, a = GAINS
    law = part.all * (kp + part.integral * ki / x + kd * x) * (a / (x + a)) ** 2
    load = plant.inertia * x * x + plant.damping * x + plant.stiffness
    loop = law * plant.gain * np.exp(-TUNING.delay * x) / load / (lag * x + 1.0)
    return np.max(1.0 / np.abs(1.0 + loop))


def test_the_pair_that_the_gains_were_found_for_bears_all_of_them():
    assert share(GAINS, PAIR) == Share(1.0, 1.0)


def test_a_crank_bears_all_but_the_integral_gain():
    assert rightmost(CRANK, Share(1.0, 1.0), 0.0) > 0.0  # with all of them it is unstable
    found = share(GAINS, CRANK)
    assert found.all == 1.0
    assert 0.25 < found.integral < 0.5


@pytest.mark.parametrize('inertia', [0.02, 0.0825, 0.3])
@pytest.mark.parametrize('stiffness', [-3.0, 2.0, 8.0, 30.0])
@pytest.mark.parametrize('damping', [0.05, 0.4])
@pytest.mark.parametrize('gain', [1e-5, 8e-5, 3e-4])
def test_what_is_left_is_stable_or_refused(inertia, stiffness, damping, gain):
    plant = LinearPlant(inertia, damping, stiffness, gain)
    found = share(GAINS, plant)
    if found is None:
        # No share of the gains holds what falls faster than their proportional part returns it.
        assert stiffness + GAINS[0] * gain < 0.1 * abs(stiffness)
        return
    for lag in (0.0, TUNING.lag):
        assert rightmost(plant, found, lag) < 0.0


def test_of_all_shares_within_the_bounds_it_is_one_with_the_most_integral_gain():
    found = share(GAINS, CRANK)
    assert peak(CRANK, found, 0.0) <= 1.01 * TUNING.peak
    assert peak(CRANK, found, TUNING.lag) <= 1.01 * TUNING.late_peak
    more = 2.0 ** (1.0 / TUNING.steps) * found.integral
    for of_all in (1.0, 0.707, 0.5):
        part = Share(of_all, min(more / of_all, 1.0))
        peaks = peak(CRANK, part, 0.0) / TUNING.peak, peak(CRANK, part, TUNING.lag) / 2.0
        assert max(peaks) > 1.0 or rightmost(CRANK, part, TUNING.lag) > 0.0


def test_a_quick_joint_bears_less_of_all_gains():
    light = LinearPlant(0.01, 0.3, 31.3, 1.67e-4)
    found = share(GAINS, light)
    assert found.all < 0.6
    assert found.integral == 1.0


def test_pressure_without_effect_controls_nothing():
    assert share(GAINS, LinearPlant(0.0825, 0.2, 8.0, 0.0)) is None
