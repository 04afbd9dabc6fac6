# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated rig with its valves and sensors, step by step: all of ``pam_sim`` except ROS."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.rig.simulated_sensors import SimulatedSensors
from pam_ros.rig.simulation import Simulation
from pam_ros.settings.scene import SimulationSetup
from pam_ros.simulator.contractions import Contractions
from pam_ros.simulator.pressure_input import PressureInput
from pam_ros.simulator.venting import Venting

Array = NDArray[np.float64]
OneReading = tuple[float, float, float, float, float, float]  # see Plant.read_one
FINE = 1e-3  # s of simulated time for which a venting valve keeps a pressure


class BadCommand(NamedTuple):
    """A command that was clamped or refused."""

    muscle: int
    reason: str
    is_refused: bool  # else clamped


@dataclass(frozen=True)
class Reading:
    """The readings of the sensors, and the exact stiffness and damping of the muscles.

    Values of joints are (joints,) in m or rad, values of muscles are (muscles,), all SI.
    """

    position: Array
    velocity: Array
    effort: Array
    pressure: Array
    force: Array
    stiffness: Array
    damping: Array


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
        pressures, positions, velocities = setup.initial
        self._simulation.reset(pressures, positions, velocities)
        self._sensors = SimulatedSensors(self._simulation, setup.sensors)
        self.contractions.forget()
        self.step = 0
        self._ordered = pressures.copy()  # Pa, the last commands of the valves
        # Simulated time of each muscle's last valid command, NaN before the first one.
        self.commanded_at = np.full(len(pressures), np.nan)
        self.has_timed_out = np.zeros(len(pressures), dtype=bool)
        self._deadline = math.inf  # simulated time at which the next timeout is reached
        self._venting = Venting()

    @property
    def time(self) -> float:
        """Simulated time in s since the start or the last reset."""
        return self._simulation.time

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

    def take(self, muscle: int, value: float) -> BadCommand | None:
        """Command one muscle in Pa; return the problem of the command, or None."""
        given = self.inputs[muscle]
        pressure = given.take(value)
        if pressure is None:
            return self._bad(muscle, is_refused=True)
        self._venting.end(muscle)
        self._order(muscle, pressure)
        self.commanded_at[muscle] = self._simulation.time
        self.has_timed_out[muscle] = False
        self._set_deadline()
        return None if pressure == value else self._bad(muscle)

    def _bad(self, muscle: int, *, is_refused: bool = False) -> BadCommand:
        whose = f'{self.setup.muscle_names[muscle]}: ' if len(self.inputs) > 1 else ''
        return BadCommand(muscle, whose + self.inputs[muscle].reason, is_refused)

    def take_all(self, values: list[float]) -> BadCommand | None:
        """Command all muscles in Pa; return the problem of the last bad command, or None.

        A refused value leaves its muscle unchanged; a value outside the limits is clamped.
        """
        bad, now, ordered = None, self._simulation.time, self._ordered
        for i, (given, value) in enumerate(zip(self.inputs, values, strict=True)):
            pressure = given.take(value)
            if pressure != value:
                bad = self._bad(i, is_refused=pressure is None)
            if pressure is not None:
                self._venting.end(i)
                ordered[i] = pressure
                self.commanded_at[i] = now
                self.has_timed_out[i] = False
        self._simulation.command(ordered)
        self._set_deadline()
        return bad

    def _order(self, muscle: int, pressure: float) -> None:
        self._ordered[muscle] = pressure
        self._simulation.command_one(muscle, pressure)

    def _order_all(self, pressures: Array) -> None:
        self._ordered = np.clip(pressures, *self.setup.limits)
        self._simulation.command(self._ordered)

    def _set_deadline(self) -> None:
        timeout = self.setup.settings.command_timeout
        if len(self.commanded_at) == 1:
            last = self.commanded_at.item()
            is_watched = timeout and not (math.isnan(last) or self.has_timed_out.item())
            self._deadline = last + timeout if is_watched else math.inf
            return
        last = self.commanded_at[~np.isnan(self.commanded_at) & ~self.has_timed_out]
        self._deadline = float(last.min()) + timeout if timeout and last.size else math.inf

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

    def read_one(self) -> OneReading:
        """Return position, velocity, pressure, force, stiffness and damping of a single muscle.

        Raises ArithmeticError if the muscle is out of its reach, or its force or velocity is not
        finite.
        """
        simulation = self._simulation
        force, stiffness, damping, acceleration = (
            column.item() for column in simulation.muscle_outputs()
        )
        position, velocity = simulation.position.item(), simulation.velocity.item()
        pressure = simulation.pressure.item()
        l0 = self.setup.muscles[0].l0
        reach = self.setup.reach.item() * l0
        if not (abs(position) < reach and math.isfinite(force + velocity)):
            raise ArithmeticError(f"the position {position:g} m is out of the muscle's reach")
        self.contractions.record_one(simulation.time, position / l0, self.setup.rated.item())
        sensors = self._sensors.of_joints
        if not sensors.is_ideal:
            sample = np.array([[position], [velocity], [pressure], [force], [acceleration]])
            reading = sensors.read(simulation.time, sample)
            position, velocity, pressure, force = reading[:, 0].tolist()
        return position, velocity, pressure, force, stiffness, damping

    def read(self) -> Reading:
        """Return the readings of all sensors.

        Raises ArithmeticError if a muscle is out of its reach, or a force or velocity is not
        finite.
        """
        simulation = self._simulation
        force, stiffness, damping, _ = simulation.muscle_outputs()
        contraction = simulation.contraction
        is_there = np.abs(contraction) < self.setup.reach
        if not (np.all(is_there) and np.isfinite(np.sum(force) + np.sum(simulation.velocity))):
            lost = self.setup.muscle_names[int(np.argmin(is_there))]
            raise ArithmeticError(f'{lost} is out of its reach')
        self.contractions.record(simulation.time, contraction, self.setup.rated)
        return Reading(*self._sensors.read(), stiffness, damping)
