# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What ``pam_sim`` simulates: its muscles and joints, put together from flat parameters."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.assembly import Model
from pam_ros.rig.joint_model import JointModel
from pam_ros.rig.sensors import Sensors
from pam_ros.settings.rig import RigParameters
from pam_ros.settings.sim import SimSettings, Start
from pam_ros.settings.tables import Table, Values, build, table_of

Array = NDArray[np.float64]

START = (-0.2, 0.95)  # contractions at which a simulation may start


class Scene(RigParameters):
    """The muscles and joints that are simulated, and their parameters."""

    common: ClassVar[Table] = {**table_of(Sensors, 'sensor.'), **table_of(SimSettings)}
    start: ClassVar[Table] = table_of(Start, 'initial.')

    def build(self, values: Values) -> 'Simulation':
        """Make the simulation of checked flat *values*; ParameterError where they make none."""
        starts, pressures = (
            tuple(build(Start, self.of(values, name), 'initial.') for name in names)
            for names in (self.joints, self.muscles)
        )
        return Simulation(
            self.models(values),
            self.muscles,
            self.joints,
            build(Sensors, values, 'sensor.'),
            build(SimSettings, values),
            starts,
            tuple(start.pressure for start in pressures),
        )


@dataclass(frozen=True)
class Simulation:
    """All that the node is told, checked together.

    ``models`` are the joints, ``starts`` theirs; ``pressures`` (Pa) are those of the muscles.
    """

    models: tuple[Model, ...]
    muscle_names: tuple[str, ...]
    joint_names: tuple[str, ...]
    sensors: Sensors
    settings: SimSettings
    starts: tuple[Start, ...]
    pressures: tuple[float, ...]

    def __post_init__(self) -> None:
        """Refuse a step that is too long, and a start that the muscles cannot have."""
        for model in {id(model): model for model in self.models}.values():
            model.check_step(1.0 / self.settings.physics_rate)
        for muscle, pressure, name in zip(
            self.muscles, self.pressures, self.muscle_names, strict=True
        ):
            if not muscle.p_min <= pressure <= muscle.p_max:
                raise ParameterError(
                    f'{self._whose(name)}initial.pressure = {pressure:g} Pa is outside p_min = '
                    f'{muscle.p_min:g} to p_max = {muscle.p_max:g} Pa'
                )
        for model, start, name in zip(self.models, self.starts, self.joint_names, strict=True):
            if not start.at_rest:
                self._check_position(model, start.position, self._whose(name))

    def _whose(self, name: str) -> str:
        return f'{name}: ' if len(self.models) > 1 else ''

    def _check_position(self, model: Model, position: float, whose: str) -> None:
        if isinstance(model, JointModel):
            ends = [
                sorted(model.joint.coordinate(k * m.l0, i, model.geometry) for k in START)
                for i, m in enumerate(model.muscles)
            ]
            low, high = max(end[0] for end in ends), min(end[1] for end in ends)
            unit, of = model.joint.unit, f'joint = {self.settings.joint}'
        elif model.muscle.is_load_only:
            return
        else:
            low, high = (bound * model.muscle.l0 for bound in START)
            unit, of = 'm', f'a muscle of {model.muscle.l0:g} m'
        if not low <= position <= high:
            raise ParameterError(
                f'{whose}initial.position = {position:g} {unit} is no '
                f'{"place" if isinstance(model, JointModel) else "length"} of {of}: give '
                f'{low:g} to {high:g} {unit}'
            )

    @cached_property
    def muscles(self) -> tuple[Muscle, ...]:
        """All muscles in order."""
        return tuple(chain.from_iterable(map(_muscles_of, self.models)))

    @property
    def is_one(self) -> bool:
        """Whether there is one muscle alone."""
        return len(self.muscles) == 1

    @cached_property
    def reach(self) -> Array:
        """Contraction at which each muscle would have no length left; inf where there is none."""
        return np.array([np.inf if m.is_load_only else 1.0 for m in self.muscles])

    @cached_property
    def limits(self) -> Array:
        """Least and largest pressure in Pa of each muscle, (2, muscles)."""
        return np.array([[m.p_min for m in self.muscles], [m.p_max for m in self.muscles]])

    @cached_property
    def initial(self) -> tuple[Array, Array, Array]:
        """Pressures in Pa, then positions (m, rad) and velocities of the joints, at the start."""
        pressures = iter(self.pressures)
        positions, velocities = [], []
        rests: dict[tuple[int, tuple[float, ...]], float] = {}
        for model, start in zip(self.models, self.starts, strict=True):
            p = tuple(next(pressures) for _ in _muscles_of(model))
            if start.at_rest:
                key = id(model), p
                if key not in rests:
                    rests[key] = _rest(model, p)
                positions.append(rests[key])
                velocities.append(0.0)
            else:
                positions.append(start.position)
                velocities.append(start.velocity)
        return np.array(self.pressures), np.array(positions), np.array(velocities)


def _muscles_of(model: Model) -> Iterable[Muscle]:
    return model.muscles if isinstance(model, JointModel) else (model.muscle,)


def _rest(model: Model, pressures: tuple[float, ...]) -> float:
    return model.rest(pressures) if isinstance(model, JointModel) else model.rest(pressures[0])


def table(**given: Any) -> Table:
    """Return the table of all parameters of a node that is started with *given*."""
    return Scene(given).table()


def simulation(values: Values) -> Simulation:
    """Make the simulation of a complete set of flat, checked values."""
    return Scene(values).build(values)
