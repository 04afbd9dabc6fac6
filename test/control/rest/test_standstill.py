# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Calm at the goal, and the stiffness that a load shows."""

import math

import numpy as np
import pytest

from pam_ros.control.rest.standstill import Standstill, StandstillTuning

DT = 2e-3
K = 7000.0
TOLERANCE = 12e-6
TUNING = StandstillTuning()


def at(standstill, error, seconds, moves=False):
    for _ in range(round(seconds / DT)):
        standstill.see_error(DT, error, moves)


def test_bandwidth_is_full_while_it_moves_and_for_a_moment_after():
    standstill = Standstill(TOLERANCE, TUNING)
    assert standstill.factor == 0.0
    at(standstill, 0.0, DT, moves=True)
    assert standstill.factor == 1.0
    at(standstill, 0.0, TUNING.after - 2 * DT)
    assert (standstill.factor, standstill.is_moving) == (1.0, True)
    at(standstill, 0.0, 3.0)
    assert standstill.factor < 1e-4
    assert not standstill.is_moving


def test_an_error_brings_the_bandwidth_back():
    standstill = Standstill(TOLERANCE, TUNING)
    at(standstill, 0.99 * TOLERANCE, 1.0)
    assert standstill.factor == 0.0
    at(standstill, (0.5 + 0.5 * TUNING.full) * TOLERANCE, 1.0)
    assert standstill.factor == pytest.approx(0.5, abs=1e-6)
    at(standstill, -1e-3, 0.2)
    assert standstill.factor == 1.0


def test_noise_that_averages_out_is_no_error():
    standstill, noise = Standstill(TOLERANCE, TUNING), np.random.default_rng(2)
    seen = []
    for _ in range(5000):
        standstill.see_error(DT, 20e-6 * noise.standard_normal(), False)
        seen.append(standstill.factor)
    assert np.mean(seen) < 0.01


def stiffness_seen(k, seconds=1.5, noise=0.0):
    """Return what is seen of a load with stiffness k (N/m) that is pulled by 10 N/s."""
    rng = np.random.default_rng(4)
    standstill = Standstill(TOLERANCE, TUNING)
    at(standstill, 0.0, 1.0)
    for n in range(round(seconds / DT)):
        force = 200.0 + 10.0 * n * DT
        place = 0.06 + (force - 200.0) / k + noise * rng.standard_normal()
        standstill.see_error(DT, 0.0, False)
        standstill.see_force(DT, force, place, K)
    return standstill.stiffness


def test_a_load_that_sticks_shows_its_contact():
    assert stiffness_seen(K) == pytest.approx(1.0)
    assert stiffness_seen(1e6, noise=20e-6) > 2.5
    assert stiffness_seen(math.inf) <= TUNING.stiffest
    assert stiffness_seen(4.0 * K) == pytest.approx(2.0, abs=1.0)


def test_a_motion_gives_no_information_on_stiffness():
    standstill = Standstill(TOLERANCE, TUNING)
    for n in range(500):
        standstill.see_error(DT, 1e-3, True)
        standstill.see_force(DT, 200.0 + n, 0.06, K)
    assert standstill.stiffness == 1.0
