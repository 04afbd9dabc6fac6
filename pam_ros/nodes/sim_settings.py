# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What ``pam_sim`` is told beside the rig itself: rates, time-out, start, names."""

import math
from dataclasses import dataclass
from typing import Any

from pam_ros.config import Table, build, build_rig, rig_table, table_of, with_defaults
from pam_ros.errors import ParameterError
from pam_ros.parameter_files import read_known
from pam_ros.parameters import Parameter, check_all, parameter
from pam_ros.rig.model import RigModel
from pam_ros.rig.sensors import Sensors

START = (-0.2, 0.95)  # contractions at which a simulation may start


@dataclass(frozen=True)
class SimSettings:
    """Rates, safety and names of the simulator node."""

    physics_rate: float = parameter(
        1000.0, 'integration steps per second', 'Hz', low=100.0, high=100e3, live=False
    )
    publish_rate: float = parameter(
        500.0, 'messages per second on each topic', 'Hz', low=1.0, high=5000.0
    )
    command_timeout: float = parameter(
        1.0,
        'silence of pressure_command after which on_timeout acts, once a command has come; '
        '0: never',
        's',
        low=0.0,
        high=3600.0,
    )
    on_timeout: str = parameter(
        'vent',
        'what the valve does when commands stay away: vent to 0 Pa, or hold the last one',
        choices=('vent', 'hold'),
    )
    ambient_pressure: float = parameter(
        101325.0,
        'absolute pressure around the muscle, added to the gauge pressure on topic pressure',
        'Pa',
        low=0.0,
        high=1e6,
    )
    joint_name: str = parameter('pam', 'name of the joint in joint_states', live=False)
    frame_id: str = parameter('', 'frame in the headers of joint_states and pressure')

    def __post_init__(self) -> None:
        """Check every field, then the rates against each other."""
        check_all(self)
        if self.publish_rate > self.physics_rate:
            raise ParameterError(
                f'publish_rate = {self.publish_rate:g} Hz is above physics_rate = '
                f'{self.physics_rate:g} Hz: there is nothing new to publish so often'
            )


@dataclass(frozen=True)
class Start:
    """The state at the start and after each reset, long at rest there as far as memories go."""

    pressure: float = parameter(0.0, 'gauge pressure at the start', 'Pa', low=-101325.0, high=5e6)
    at_rest: bool = parameter(
        True, 'start where the load rests at initial.pressure; false: at initial.position'
    )
    position: float = parameter(
        0.0, 'contraction at the start unless initial.at_rest', 'm', low=-5.0, high=9.0
    )
    velocity: float = parameter(
        0.0, 'velocity at the start unless initial.at_rest', 'm/s', low=-100.0, high=100.0
    )

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self)


@dataclass(frozen=True)
class Simulation:
    """All that the node is told, checked together."""

    model: RigModel
    sensors: Sensors
    settings: SimSettings
    start: Start

    def __post_init__(self) -> None:
        """Refuse a step that is too long, and a start that the muscle cannot have."""
        self.model.check_step(1.0 / self.settings.physics_rate)
        muscle, start = self.model.muscle, self.start
        if not muscle.p_min <= start.pressure <= muscle.p_max:
            raise ParameterError(
                f'initial.pressure = {start.pressure:g} Pa is outside p_min = {muscle.p_min:g} '
                f'to p_max = {muscle.p_max:g} Pa'
            )
        low, high = ((bound * muscle.l0) for bound in START)
        if not (muscle.is_load_only or start.at_rest or low <= start.position <= high):
            raise ParameterError(
                f'initial.position = {start.position:g} m is no length of a muscle of '
                f'{muscle.l0:g} m: give {low:g} to {high:g} m'
            )

    @property
    def reach(self) -> float:
        """Position in m at which a muscle would have no length left; inf where there is none."""
        muscle = self.model.muscle
        return math.inf if muscle.is_load_only else muscle.l0

    @property
    def initial(self) -> tuple[float, float, float]:
        """Pressure in Pa, position in m and velocity in m/s at the start."""
        start = self.start
        if start.at_rest:
            return start.pressure, self.model.rest(start.pressure), 0.0
        return start.pressure, start.position, start.velocity


MUSCLE: Table = {
    'muscle': (
        str,
        '',
        Parameter(
            'what is not given as a parameter comes from here: a muscle of this package, such as '
            'dmsp_20_400n, or the path of a parameter file',
            live=False,
        ),
    )
}


def table(muscle: Any = '') -> Table:
    """Return the table of all parameters; their defaults come from *muscle* where it is given."""
    plain = {
        **MUSCLE,
        **rig_table(),
        **table_of(Sensors, 'sensor.'),
        **table_of(SimSettings),
        **table_of(Start, 'initial.'),
    }
    return with_defaults(plain, read_known(str(muscle), plain)) if muscle else plain


def simulation(values: dict[str, Any]) -> Simulation:
    """Make a simulation from flat values; raises ParameterError where they make none."""
    return Simulation(
        build_rig(values),
        build(Sensors, values, 'sensor.'),
        build(SimSettings, values),
        build(Start, values, 'initial.'),
    )
