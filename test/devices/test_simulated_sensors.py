# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Sensors of a simulation: ideal ones read its state, others an earlier one, noisy, in steps."""

import numpy as np
import pytest

from pam_ros import (
    Arm,
    Mass,
    Muscle,
    PamError,
    Sensors,
    SimulatedSensors,
    Simulation,
    antagonistic_joint,
    single_muscle_joint,
)

ELBOW = antagonistic_joint(Muscle(), radius=0.04, load=Arm(1.0, 0.25), contraction=0.1)
LIFT = single_muscle_joint(Muscle(), Mass(20.0))
EACH = pytest.mark.parametrize(
    'joints', [[LIFT], [LIFT, LIFT], [ELBOW], [ELBOW, LIFT]], ids=['one', 'two', 'pair', 'both']
)


def moving(joints):
    """Return a simulation that has just been given a step of all pressures."""
    simulation = Simulation(joints)
    simulation.command(300e3)
    return simulation


def state(simulation):
    """Return position, velocity, effort, pressure and force of a simulation."""
    effort = simulation.joint_outputs().effort
    force = simulation.muscle_outputs().force
    return simulation.position, simulation.velocity, effort, simulation.pressure, force


@EACH
def test_ideal_sensors_read_the_state(joints):
    simulation = moving(joints)
    sensors = SimulatedSensors(simulation, Sensors())
    simulation.advance(50)
    for reading, true in zip(sensors.read(), state(simulation), strict=True):
        np.testing.assert_array_equal(reading, true)


@EACH
def test_late_sensors_read_the_state_of_then(joints):
    simulation = moving(joints)
    sensors = SimulatedSensors(simulation, Sensors(latency=0.010))
    states = []
    for _ in range(40):
        states.append(state(simulation))
        readings = sensors.read()
        then = states[max(len(states) - 6, 0)]  # five periods of 2 ms before the last
        for reading, true in zip(readings, then, strict=True):
            np.testing.assert_allclose(reading, true, rtol=1e-9, atol=1e-12)
        simulation.advance(2)


@EACH
def test_noise_is_that_of_each_sensor_and_repeats_with_its_seed(joints):
    simulation = moving(joints)
    noisy = Sensors(position_noise=1e-4, velocity_noise=1e-3, pressure_noise=500.0, force_noise=2)

    def errors(sensors):
        made = SimulatedSensors(simulation, sensors)
        rows = [np.concatenate(made.read()) for _ in range(2000)]
        return np.array(rows) - np.concatenate(state(simulation))

    found = errors(noisy)
    joint, muscles = len(simulation.joints), len(simulation.pressure)
    expected = np.repeat([1e-4, 1e-3, 2.0, 500.0, 2.0], [joint, joint, joint, muscles, muscles])
    np.testing.assert_allclose(np.std(found, axis=0), expected, rtol=0.1)
    assert np.all(np.abs(np.mean(found, axis=0)) < 5.0 * expected / np.sqrt(2000.0))
    np.testing.assert_array_equal(errors(noisy), found)


def test_resolution_rounds_and_can_be_changed():
    simulation = moving([ELBOW])
    sensors = SimulatedSensors(simulation, Sensors(position_resolution=1e-3))
    simulation.advance(50)
    (angle,) = simulation.position
    assert sensors.read().position == [np.round(angle / 1e-3) * 1e-3]
    sensors.change(Sensors())
    assert sensors.read().position == [angle]


def test_other_objects_are_refused():
    with pytest.raises(PamError, match='give a Simulation'):
        SimulatedSensors(ELBOW, Sensors())
    with pytest.raises(PamError, match='give Sensors'):
        SimulatedSensors(moving([LIFT]), 0.01)
