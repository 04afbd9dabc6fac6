# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The way of the pressure against the rig's, and its inverse against the wish."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pam_ros.control.pressure_path import PressurePath
from pam_ros.effects import DeadBand, DeadTime, PressureLag, PressureOffset
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support.scaled import scaled_muscle

DT = 2e-3
EFFECTS = [
    DeadTime(delay=0.01),
    PressureOffset(offset=5e3, gain=0.02),
    PressureLag(fill=0.05, vent=0.07),
]


@pytest.mark.parametrize('zone', [0.0, 8e3])
def test_it_has_the_chamber_of_the_rig(zone):
    joint = single_muscle_joint(effects=[*EFFECTS[:2], replace(EFFECTS[2], dead_zone=zone)])
    rig, path = Simulation([joint]), PressurePath(joint, 0, 0.02)
    rig.reset([300e3], [0.06], [0.0])
    path.start(300e3)
    assert path.chamber.pressure == pytest.approx(rig.pressure[0])
    for n in range(500):
        command = 300e3 + 80e3 * math.sin(0.02 * n) + (40e3 if n > 250 else 0.0)
        rig.command([command])
        rig.advance(2)
        path.follow(command, DT)
        assert path.chamber.pressure == pytest.approx(rig.pressure[0], abs=1.0)


@pytest.mark.parametrize('effects', [(), EFFECTS])
def test_a_foreseen_pressure_arrives_without_lag(effects):
    path = PressurePath(single_muscle_joint(effects=effects), 0, 0.02)
    start = path.command_at_rest(300e3)
    path.start(start)
    error = []
    for n in range(2000):
        t = n * DT
        wanted = 300e3 + 40e3 * (1.0 - math.cos(2.0 * t))
        rate = 80e3 * math.sin(2.0 * t)
        path.follow(path.command_for(wanted, rate), DT)
        error.append(path.chamber.pressure - (300e3 + 40e3 * (1.0 - math.cos(2.0 * (t + DT)))))
    # 80 kPa/s behind by the lag and the dead time would be 4 to 6 kPa.
    assert np.max(np.abs(error)) < 0.6e3


@pytest.mark.parametrize('lag', [0.0, 0.06])
def test_most_of_a_dead_zone_is_compensated(lag):
    zone = [PressureLag(fill=lag, vent=lag, dead_zone=6e3)]
    path = PressurePath(single_muscle_joint(effects=zone), 0, 0.02)
    path.start(300e3)
    error = []
    for n in range(2000):
        wanted, rate = 300e3 + 40e3 * math.sin(2.0 * n * DT), 80e3 * math.cos(2.0 * n * DT)
        path.follow(path.command_for(wanted, rate), DT)
        error.append(path.chamber.pressure - (300e3 + 40e3 * math.sin(2.0 * (n + 1) * DT)))
    # Without compensation it is the zone.
    assert np.max(np.abs(error)) < 0.3 * 6e3
    for _ in range(500):
        path.follow(path.command_for(250e3, 0.0), DT)
    assert path.chamber.pressure == pytest.approx(250e3, abs=0.3 * 6e3)


def test_at_rest_the_chamber_has_the_wanted_pressure():
    path = PressurePath(single_muscle_joint(effects=EFFECTS), 0, 0.02)
    path.start(0.0)
    for _ in range(1000):
        path.follow(path.command_for(250e3, 0.0), DT)
    assert path.chamber.pressure == pytest.approx(250e3, abs=1e-3)


def test_a_dead_band_is_made_up_for():
    band = [DeadBand(band=4e4, width=2e3), PressureOffset(gain=0.1)]
    joint = single_muscle_joint(effects=band)
    rig, path = Simulation([joint]), PressurePath(joint, 0, 0.02)
    for pressure in (0.0, 1e3, 1e4, 2e5):
        command = path.command_at_rest(pressure)
        assert command >= 4e4 / 1.1  # at its edge, from where the muscle can pull at once
        rig.reset([command], [0.06], [0.0])
        assert rig.pressure[0] == pytest.approx(path.reached(command), abs=1e-9)
        assert rig.pressure[0] == pytest.approx(pressure, abs=501.0)  # a quarter of the width


def test_the_lag_of_what_is_not_foreseen_shrinks_to_the_quickest():
    path = PressurePath(single_muscle_joint(effects=[PressureLag(fill=0.06, vent=0.06)]), 0, 0.02)
    path.start(100e3)
    for n in range(100):
        path.follow(path.command_for(200e3, 0.0), 1e-4)
        left = 200e3 - path.chamber.pressure
        assert left == pytest.approx(100e3 * math.exp(-(n + 1) * 1e-4 / 0.02), rel=2e-3)


@pytest.mark.parametrize(('pressure', 'band'), [(1.0, 510e3), (0.013, 20e3)])
def test_a_dead_band_that_no_command_exceeds_is_refused(pressure, band):
    muscle = scaled_muscle(Muscle(), 1.0, pressure, 1.0)
    joint = single_muscle_joint(muscle, effects=[DeadBand(band=band)])
    with pytest.raises(ParameterError, match='does not raise the pressure in the chamber'):
        PressurePath(joint, 0, 0.02)
