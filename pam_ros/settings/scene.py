# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The muscles and joints that ``pam_sim`` simulates, built from flat parameters."""

from dataclasses import dataclass
from itertools import chain
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from pam_ros.cached_property import cached_property
from pam_ros.devices.sensors import Sensors
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import statics
from pam_ros.rig.arrangements import LOAD
from pam_ros.rig.joint import Joint
from pam_ros.rig.step_limit import check_step
from pam_ros.settings.rig import RigParameters
from pam_ros.settings.sim import SimSettings, Start
from pam_ros.settings.tables import Table, Values, build, table_of

Array = NDArray[np.float64]


class Scene(RigParameters):
    """The muscles and joints that are simulated, and their parameters."""

    start: ClassVar[Table] = table_of(Start, 'initial.')

    def __init__(self, given: Values) -> None:
        """Read the names among the *given* parameters; refuse an unknown one of ``initial.*``."""
        super().__init__(given)
        for name in given:
            if name.startswith('initial.') and name not in self.start:
                raise ParameterError(
                    f'{name} is not a parameter: give one of {", ".join(self.start)}; effects '
                    'start as after a long rest'
                )

    @property
    def common(self) -> Table:
        """The table of the common parameters in addition to those of the rig."""
        return {**table_of(Sensors, 'sensor.'), **table_of(SimSettings)}

    def build(self, values: Values) -> 'SimulationSetup':
        """Create the setup from checked flat *values*; ParameterError if they are not valid."""
        starts = [
            build(Start, self.of_joint(values, k), 'initial.') for k in range(len(self.joints))
        ]
        pressures = [
            build(Start, self.of_muscle(values, i), 'initial.').pressure
            for i in range(len(self.muscles))
        ]
        return SimulationSetup(
            self.build_joints(values),
            self.muscles,
            self.joints,
            build(Sensors, values, 'sensor.'),
            build(SimSettings, values),
            tuple(starts),
            tuple(pressures),
        )


@dataclass(frozen=True)
class SimulationSetup:
    """All settings of the node, checked together.

    ``starts`` are those of the joints, ``pressures`` (Pa) those of the muscles.
    """

    joints: tuple[Joint, ...]
    muscle_names: tuple[str, ...]
    joint_names: tuple[str, ...]
    sensors: Sensors
    settings: SimSettings
    starts: tuple[Start, ...]
    pressures: tuple[float, ...]

    def __post_init__(self) -> None:
        """Refuse a step that is too long, and an initial state that the muscles cannot have."""
        for joint in {id(joint): joint for joint in self.joints}.values():
            check_step(joint, 1.0 / self.settings.physics_rate)
        for muscle, pressure, name in zip(
            self.muscles, self.pressures, self.muscle_names, strict=True
        ):
            if not muscle.p_min <= pressure <= muscle.p_max:
                raise ParameterError(
                    f'{self._whose(name)}initial.pressure = {pressure:g} Pa is outside p_min = '
                    f'{muscle.p_min:g} to p_max = {muscle.p_max:g} Pa'
                )
        for joint, start, name in zip(self.joints, self.starts, self.joint_names, strict=True):
            if not (start.at_rest or joint.is_driven):
                what = f'{self._whose(name)}initial.position'
                kind = f'joint = {self.settings.joint}'
                statics.refuse_position(what, start.position, joint, kind)

    def _whose(self, name: str) -> str:
        return f'{name}: ' if len(self.joints) > 1 else ''

    @cached_property
    def muscles(self) -> tuple[Muscle, ...]:
        """All muscles in order."""
        return tuple(chain.from_iterable(joint.muscles for joint in self.joints))

    @cached_property
    def are_direct(self) -> bool:
        """Whether each joint is one muscle on a mass, whose force is the joint's effort."""
        return all(map(statics.is_direct, self.joints))

    @property
    def has_arrays(self) -> bool:
        """Whether there are topics with arrays for all muscles: not of one muscle on a mass."""
        return len(self.muscles) > 1 or not self.are_direct

    @property
    def muscle_prefixes(self) -> tuple[str, ...]:
        """What the names of each muscle's own topics begin with; empty if there are none."""
        if not self.has_arrays:
            return ('',)
        return tuple(f'{n}/' for n in self.muscle_names) if self.settings.muscle_topics else ()

    @property
    def muscle_joints(self) -> tuple[str, ...]:
        """Names of the joints of the muscles, in the muscles' own topics; empty if they share one.

        A muscle with its own load is the only one of its joint.
        """
        if not self.has_arrays:
            return self.joint_names
        return self.muscle_names if self.settings.joint == LOAD.name else ()

    @property
    def command_topics(self) -> tuple[str, ...]:
        """The topics of commands: that for all muscles, then those of each muscle."""
        own = tuple(f'{prefix}pressure_command' for prefix in self.muscle_prefixes)
        return ('pressure_commands', *own) if self.has_arrays else own

    @cached_property
    def reach(self) -> tuple[float, ...]:
        """Contraction at which the length of each muscle is 0; inf for a plain force source."""
        return tuple(np.inf if m.is_load_only else 1.0 for m in self.muscles)

    @cached_property
    def rated(self) -> tuple[float, ...]:
        """Largest permitted contraction of each muscle; inf for a plain force source."""
        return tuple(np.inf if m.is_load_only else m.kappa_max for m in self.muscles)

    @cached_property
    def limits(self) -> Array:
        """Least and largest pressure in Pa of each muscle, (2, muscles)."""
        return np.array([[m.p_min for m in self.muscles], [m.p_max for m in self.muscles]])
