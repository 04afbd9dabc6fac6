# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated rig with its valves and sensors, step by step: all of ``pam_sim`` except ROS."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.devices.pressure_input import PressureInput
from pam_ros.devices.simulated_sensors import SimulatedSensors
from pam_ros.devices.venting import Venting
from pam_ros.rig.simulation import Simulation
from pam_ros.settings.scene import SimulationSetup
from pam_ros.simulator.contractions import Contractions
from pam_ros.simulator.initial import initial_state

Array = NDArray[np.float64]
FINE = 1e-3  # s of simulated time for which a venting valve keeps a pressure


class BadCommand(NamedTuple):
    """A command that was clamped or refused."""

    muscle: int
    reason: str
    is_refused: bool  # else clamped


class PlantReading(NamedTuple):
    """The readings of the sensors, and the exact stiffness and damping of the muscles.

    Values of joints are (joints,) in m or rad, values of muscles are (muscles,), all SI. They are
    lists, since Python computes with lists of a few numbers faster than with arrays.
    """

    position: list[float]
    velocity: list[float]
    effort: list[float]
    pressure: list[float]
    force: list[float]
    stiffness: list[float]
    damping: list[float]


class Plant:
    """Muscles with the valves that receive their commands, and the sensors that measure them."""

    def __init__(self, setup: SimulationSetup) -> None:
        """Create the rig in its initial state."""
        self.setup = setup
        self.timeouts = 0  # how often commands of a muscle stopped for longer than the timeout
        self.inputs = [PressureInput(muscle) for muscle in setup.muscles]
        self._simulation = Simulation(setup.joints, 1.0 / setup.settings.physics_rate)
        self._all = range(len(self.inputs))
        self.contractions = Contractions()
        self.begin()
        # Otherwise the first step or a change of effects would wait for the compiler.
        self._simulation.prepare()

    def begin(self) -> None:
        """Set the initial state; the noise starts again."""
        setup = self.setup
        pressures, positions, velocities = initial_state(setup)
        self._simulation.reset(pressures, positions, velocities)
        self._sensors = SimulatedSensors(self._simulation, setup.sensors)
        self.contractions.forget()
        self.step = 0
        self._ordered = pressures.copy()  # Pa, the last commands of the valves
        # Simulated time of each muscle's last valid command, NaN before the first one.
        self.commanded_at = [math.nan] * len(pressures)
        self.has_timed_out = [False] * len(pressures)
        # Simulated time at which to look for timeouts, never after the next one. It is not moved
        # by every command, which would take as long as the command itself.
        self._deadline = math.inf
        self._venting = Venting()

    @property
    def time(self) -> float:
        """Simulated time in s since the start or the last reset."""
        return self._simulation.time

    @property
    def position(self) -> Array:
        """The true positions of the joints (joints,) in m or rad, without errors of the sensor."""
        return self._simulation.position

    def change(self, setup: SimulationSetup) -> None:
        """Continue with other parameters."""
        self._simulation.change(setup.joints)
        self.setup = setup
        self._sensors.change(setup.sensors)
        for given, muscle in zip(self.inputs, setup.muscles, strict=True):
            given.muscle = muscle
        self._order_all(self._ordered)  # the limits may have changed
        self._set_deadline()

    def advance(self, step: int) -> None:
        """Simulate until this step."""
        rate = self.setup.settings.physics_rate
        while step > self.step:
            steps = step - self.step
            if self._venting:
                steps = min(steps, max(round(FINE * rate), 1))
                for muscle, pressure in self._venting.move(steps / rate).items():
                    self._order(muscle, self.inputs[muscle].within_limits(pressure))
            self._simulation.advance(steps)
            self.step += steps
            if self._simulation.time > self._deadline:
                self._time_out()

    # Valves ----------------------------------------------------------------------------------

    def take(self, pressures: Sequence[float], muscles: Sequence[int]) -> BadCommand | None:
        """Command these *muscles* in Pa; return the problem of the last bad command, or None.

        A refused value leaves its muscle unchanged; a value outside the limits is clamped.
        """
        bad, now = None, self._simulation.time
        for i, value in zip(muscles, pressures, strict=True):
            pressure = self.inputs[i].take(value)
            if pressure != value:
                bad = self._bad(i, is_refused=pressure is None)
            if pressure is not None:
                self._venting.end(i)
                self._order(i, pressure)
                self.commanded_at[i] = now
                self.has_timed_out[i] = False
        if self._deadline == math.inf:
            self._set_deadline()
        return bad

    def _bad(self, muscle: int, *, is_refused: bool) -> BadCommand:
        whose = f'{self.setup.muscle_names[muscle]}: ' if len(self.inputs) > 1 else ''
        return BadCommand(muscle, whose + self.inputs[muscle].reason, is_refused)

    @property
    def low_commands(self) -> str:
        """A sentence if all commands of a muscle may be in kPa or bar; empty otherwise."""
        for name, given in zip(self.setup.muscle_names, self.inputs, strict=True):
            if given.is_low:
                whose = f'{name}: ' if len(self.inputs) > 1 else ''
                return (
                    f'{whose}commands reach {given.highest:g} Pa only, and p_max is '
                    f'{given.muscle.p_max:g} Pa: they are in Pa, are these in kPa or bar?'
                )
        return ''

    def _order(self, muscle: int, pressure: float) -> None:
        self._ordered[muscle] = pressure
        self._simulation.command_one(muscle, pressure)

    def _order_all(self, pressures: Array) -> None:
        self._ordered = np.clip(pressures, *self.setup.limits)
        self._simulation.command(self._ordered)

    def _set_deadline(self) -> None:
        timeout = self.setup.settings.command_timeout
        if not timeout:
            self._deadline = math.inf
            return
        watched = [
            last
            for last, is_late in zip(self.commanded_at, self.has_timed_out, strict=True)
            if not (is_late or math.isnan(last))
        ]
        self._deadline = min(watched) + timeout if watched else math.inf

    def _time_out(self) -> None:
        settings = self.setup.settings
        for i in self._all:
            age = self._simulation.time - self.commanded_at[i]
            if age > settings.command_timeout and not self.has_timed_out[i]:
                self.has_timed_out[i] = True
                self.timeouts += 1
                if settings.on_timeout == 'vent':
                    self._vent(i, settings.vent_time)
        self._set_deadline()

    def _vent(self, muscle: int, time: float) -> None:
        rest = self.inputs[muscle].within_limits(0.0)
        if time:
            self._venting.begin(muscle, self._ordered[muscle].item(), rest, time)
        else:
            self._order(muscle, rest)

    # Sensors ---------------------------------------------------------------------------------

    def read(self) -> PlantReading:
        """Return the readings of all sensors.

        Raises ArithmeticError if a muscle is out of its reach, or a force or velocity is not
        finite.
        """
        simulation, setup = self._simulation, self.setup
        contractions = simulation.contraction.tolist()
        for name, kappa, limit in zip(setup.muscle_names, contractions, setup.reach, strict=True):
            if not abs(kappa) < limit:  # or not a number
                percent = f'{100.0 * kappa:g} %'
                raise ArithmeticError(f'{name} is out of its reach, contracted by {percent}')
        position, velocity, effort, pressure, force = self._sensors.read()
        outputs = simulation.muscle_outputs()
        reading = PlantReading(
            position.tolist(),
            velocity.tolist(),
            effort.tolist(),
            pressure.tolist(),
            force.tolist(),
            outputs.stiffness.tolist(),
            outputs.damping.tolist(),
        )
        if not math.isfinite(sum(reading.force) + sum(reading.velocity)):
            raise ArithmeticError('a force or a velocity is not finite')
        self.contractions.record(simulation.time, contractions, setup.rated)
        return reading
