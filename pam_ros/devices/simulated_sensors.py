# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The sensors of a simulation: those of its joints and those of its muscles."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.arguments import instance
from pam_ros.devices.sensors import Feedback, Sensors
from pam_ros.rig import statics
from pam_ros.rig.simulation import Simulation

Array = NDArray[np.float64]


class SensorReadings(NamedTuple):
    """The readings of the sensors: of the joints (joints,), and of the muscles (muscles,).

    ``position`` in m and ``velocity`` in m/s, rad and rad/s for a revolute joint; ``effort`` in N
    or N m; ``pressure`` in Pa gauge, ``force`` in N.
    """

    position: Array
    velocity: Array
    effort: Array
    pressure: Array
    force: Array


class SimulatedSensors:
    """Sensors that measure the state of a :class:`pam_ros.Simulation`, as those of ``pam_sim``.

    The first readings come from the present state: create new sensors after a reset of the
    simulation. Raises ParameterError for objects of another type.
    """

    def __init__(self, simulation: Simulation, sensors: Sensors) -> None:
        """Measure *simulation* with the latency, noise and resolution of *sensors*."""
        self._simulation = instance('simulation', simulation, Simulation, 'a Simulation')
        instance('sensors', sensors, Sensors, 'Sensors')
        self._are_direct = all(map(statics.is_direct, simulation.joints))
        self.of_joints = Feedback(sensors, len(simulation.position))
        # Unless each joint is one muscle on a mass, muscles have their own sensors and noise.
        self._of_muscles = Feedback(_other_noise(sensors), len(simulation.pressure))

    def change(self, sensors: Sensors) -> None:
        """Continue with other sensors; the noise starts again if its seed has changed."""
        self.of_joints.change(sensors)
        self._of_muscles.change(_other_noise(sensors))

    def read(self) -> SensorReadings:
        """Return the present readings of the sensors.

        Those of the joints are (joints,): position in m or rad, velocity in m/s or rad/s, effort
        in N or N m. Those of the muscles are (muscles,): gauge pressure in Pa and force in N.

        Call it regularly, once in each control period: with a latency a reading is interpolated
        between the states of former calls.
        """
        simulation = self._simulation
        t = simulation.time
        position, velocity = simulation.position, simulation.velocity
        pressure, force = simulation.pressure, simulation.muscle_outputs().force
        if self.of_joints.is_ideal and self._are_direct:
            return SensorReadings(position, velocity, force, pressure, force)
        effort, _, acceleration = simulation.joint_outputs()
        if self.of_joints.is_ideal:
            return SensorReadings(position, velocity, effort, pressure, force)
        if self._are_direct:
            sample = np.array([position, velocity, pressure, force, acceleration])
            position, velocity, pressure, force = self.of_joints.read(t, sample)
            return SensorReadings(position, velocity, force, pressure, force)
        none = np.zeros_like(force)
        of_muscles = np.array([none, none, pressure, force, none])
        pressure, force = self._of_muscles.read(t, of_muscles)[2:]
        sample = np.array([position, velocity, np.zeros_like(effort), effort, acceleration])
        position, velocity, _, effort = self.of_joints.read(t, sample)
        return SensorReadings(position, velocity, effort, pressure, force)


def _other_noise(sensors: Sensors) -> Sensors:
    return replace(sensors, seed=sensors.seed ^ 0x5EED)
