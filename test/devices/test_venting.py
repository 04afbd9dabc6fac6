# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Valves that lost their commands: how fast they vent, and until when."""

import pytest

from pam_ros.devices.venting import Venting


def venting(**pressures):
    """Return valves that vent within 2 s from pressures in kPa, of muscles a0, a1 and so on."""
    valves = Venting()
    for name, pressure in pressures.items():
        valves.begin(int(name[1:]), 1e3 * pressure, 0.0, 2.0)
    return valves


def test_each_falls_in_proportion_and_all_arrive_together():
    valves = venting(a0=300, a3=100)
    assert valves
    assert valves.move(0.5) == pytest.approx({0: 225e3, 3: 75e3})
    assert valves.move(1.0) == pytest.approx({0: 75e3, 3: 25e3})
    assert valves.move(0.75) == {0: 0.0, 3: 0.0}
    assert not valves


def test_a_vacuum_is_let_in():
    assert venting(a0=-60).move(0.5) == pytest.approx({0: -45e3})


def test_a_muscle_that_is_commanded_stops_venting():
    valves = venting(a0=300, a1=200)
    valves.end(0)
    valves.end(7)
    assert valves.move(1.0) == pytest.approx({1: 100e3})


def test_a_muscle_at_rest_is_vented_at_once():
    valves = venting(a0=0)
    assert valves.move(1e-3) == {0: 0.0}
    assert not valves
