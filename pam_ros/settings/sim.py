# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of ``pam_sim`` in addition to the rig: time, rates, timeout, start, names."""

from dataclasses import dataclass

from pam_ros.errors import ParameterError
from pam_ros.parameters import Parameter, check_all, parameter_field
from pam_ros.rig.arrangements import ARRANGEMENTS
from pam_ros.settings.tables import Table

SLOWEST = 0.1  # smallest speed_factor apart from 0
MUSCLE: Table = {
    'muscle': (
        str,
        '',
        Parameter(
            'source of the values of all parameters that are not given: a muscle of this package, '
            'such as dmsp_20_400n, or the path of a parameter file',
            live=False,
        ),
    )
}


@dataclass(frozen=True)
class SimSettings:
    """Time, rates, safety and names of the simulator node."""

    time_mode: str = parameter_field(
        'real_time',
        'real_time: as fast as ROS time; scaled: speed_factor times as fast as the wall clock; '
        'lockstep: one period of publish_rate for each pressure command',
        choices=('real_time', 'scaled', 'lockstep'),
        live=False,
    )
    speed_factor: float = parameter_field(
        1.0,
        'simulated seconds per second in time_mode scaled, 0.1 or more; 0: as fast as possible',
        low=0.0,
        high=1000.0,
    )
    clock_rate: float = parameter_field(
        100.0,
        'messages on /clock per simulated second, in time_mode scaled and lockstep',
        'Hz',
        low=1.0,
        high=5000.0,
    )
    step_periods: int = parameter_field(
        1, 'periods of publish_rate that ~/step simulates', '', low=1, high=100_000
    )
    physics_rate: float = parameter_field(
        1000.0, 'integration steps per second', 'Hz', low=100.0, high=100e3, live=False
    )
    publish_rate: float = parameter_field(
        500.0, 'messages per second on each topic', 'Hz', low=1.0, high=5000.0
    )
    command_timeout: float = parameter_field(
        1.0,
        'time without a pressure command after which on_timeout acts, from the first command on; '
        '0: never',
        's',
        low=0.0,
        high=3600.0,
    )
    on_timeout: str = parameter_field(
        'vent',
        'what the valve does when commands stop: vent to 0 Pa, or hold the last pressure',
        choices=('vent', 'hold'),
    )
    vent_time: float = parameter_field(
        2.0,  # so that no load of a preset falls faster than 0.15 m/s or 2.5 rad/s
        'time in which a valve that vents lowers any pressure to 0 Pa; 0: at once',
        's',
        low=0.0,
        high=60.0,
    )
    ambient_pressure: float = parameter_field(
        101325.0,
        'absolute pressure around the muscle, added to the gauge pressure on topic pressure',
        'Pa',
        low=0.0,
        high=1e6,
    )
    joint: str = parameter_field(
        'load',
        'kind of joint; ' + '; '.join(f'{kind.name}: {kind.text}' for kind in ARRANGEMENTS),
        choices=tuple(kind.name for kind in ARRANGEMENTS),
        live=False,
    )
    muscles: tuple[str, ...] = parameter_field(
        (),
        'names of the muscles in order, joint by joint; empty: the muscles of one joint',
        live=False,
    )
    muscle_topics: bool = parameter_field(
        False, 'topics of each muscle below its name, in addition to the arrays', live=False
    )
    joint_name: str = parameter_field('pam', 'name of the joint in joint_states', live=False)
    joint_names: tuple[str, ...] = parameter_field(
        (), 'names of the joints in joint_states, if there are several', live=False
    )
    frame_id: str = parameter_field('', 'frame in the headers of joint_states and pressure')

    def __post_init__(self) -> None:
        """Check every field, then the rates against each other."""
        check_all(self)
        if 0.0 < self.speed_factor < SLOWEST:
            raise ParameterError(
                f'speed_factor = {self.speed_factor:g} is not allowed: give {SLOWEST:g} or more, '
                'or 0 for as fast as possible'
            )
        for name in ('publish_rate', 'clock_rate'):
            rate = getattr(self, name)
            if rate > self.physics_rate and (name == 'publish_rate' or self.has_own_time):
                raise ParameterError(
                    f'{name} = {rate:g} Hz is above physics_rate = {self.physics_rate:g} Hz: '
                    'the state does not change so often'
                )

    @property
    def has_own_time(self) -> bool:
        """Whether the node generates ROS time and publishes it on ``/clock``."""
        return self.time_mode != 'real_time'


@dataclass(frozen=True)
class Start:
    """The state at the start and after each reset; effects start as after a long rest."""

    pressure: float = parameter_field(
        0.0, 'gauge pressure at the start', 'Pa', low=-101325.0, high=5e6
    )
    at_rest: bool = parameter_field(
        True, 'start where the load rests at initial.pressure; false: at initial.position'
    )
    position: float = parameter_field(
        0.0,
        'position at the start unless initial.at_rest; rad for a revolute joint',
        'm',
        low=-5.0,
        high=9.0,
    )
    velocity: float = parameter_field(
        0.0,
        'velocity at the start unless initial.at_rest; rad/s for a revolute joint',
        'm/s',
        low=-100.0,
        high=100.0,
    )

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self)
