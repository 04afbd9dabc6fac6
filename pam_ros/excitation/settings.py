# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The settings of an excitation: its limits, its duration, and when it stops early."""

from dataclasses import dataclass, replace

from pam_ros.errors import ParameterError
from pam_ros.excitation.segments import SEGMENTS
from pam_ros.muscle.muscle import Muscle
from pam_ros.parameters import check_all, parameter_field


@dataclass(frozen=True)
class Excitation:
    """Limits and shape of a pressure programme. Raises ParameterError if they contradict."""

    pressure_min: float = parameter_field(
        50e3, 'lowest gauge pressure of the programme', 'Pa', low=0.0, high=5e6, live=False
    )
    pressure_max: float = parameter_field(
        450e3, 'highest gauge pressure of the programme', 'Pa', low=0.0, high=5e6, live=False
    )
    pressure_rate: float = parameter_field(
        1.5e6,
        'fastest change of pressure, venting in an emergency included',
        'Pa/s',
        low=1e3,
        high=1e9,
        live=False,
    )
    contraction_min: float = parameter_field(
        -0.04,
        'contraction below which the programme stops and vents',
        'fraction of l0',
        low=-1.0,
        high=1.0,
        live=False,
    )
    contraction_max: float = parameter_field(
        0.25,
        'contraction above which the programme stops and vents',
        'fraction of l0',
        low=-1.0,
        high=1.0,
        live=False,
    )
    position_min: float = parameter_field(
        -10.0,
        'position below which the programme stops and vents as well, for a rig with stops',
        'm',
        low=-10.0,
        high=10.0,
        live=False,
    )
    position_max: float = parameter_field(
        10.0,
        'position above which the programme stops and vents as well',
        'm',
        low=-10.0,
        high=10.0,
        live=False,
    )
    silence: float = parameter_field(
        0.5,
        'time without joint_states after which the programme stops and vents',
        's',
        low=0.01,
        high=60.0,
        live=False,
    )
    duration: float = parameter_field(
        85.0, 'length of the whole programme', 's', low=30.0, high=3600.0, live=False
    )
    segments: tuple[str, ...] = parameter_field(
        tuple(SEGMENTS),
        'segments of the programme in their order; they share the duration',
        choices=tuple(SEGMENTS),
        live=False,
    )
    frequency_max: float = parameter_field(
        8.0, 'highest frequency of multisine and chirp', 'Hz', low=0.5, high=100.0, live=False
    )
    rate: float = parameter_field(
        200.0, 'commands per second', 'Hz', low=20.0, high=2000.0, live=False
    )
    seed: int = parameter_field(
        0,
        'seed of the random levels and phases; equal seeds give equal programmes',
        '',
        low=0,
        live=False,
    )
    countdown: float = parameter_field(
        3.0, 'time to read the plan before it starts', 's', low=0.0, high=60.0, live=False
    )
    patience: float = parameter_field(
        10.0,
        'longest wait for joint_states and the subscribers of the commands',
        's',
        low=0.1,
        high=3600.0,
        live=False,
    )
    subscribers: int = parameter_field(
        1,
        'subscribers of the commands without which it does not start: with 2 a recorder '
        'beside the rig misses no command',
        '',
        low=1,
        high=100,
        live=False,
    )
    joint_name: str = parameter_field(
        '', "name of the joint in joint_states; '' if there is only one", live=False
    )

    def __post_init__(self) -> None:
        """Check every field, then the conditions between them."""
        check_all(self)
        for low, high in (
            ('pressure_min', 'pressure_max'),
            ('contraction_min', 'contraction_max'),
            ('position_min', 'position_max'),
        ):
            if not getattr(self, low) < getattr(self, high):
                raise ParameterError(
                    f'{low} = {getattr(self, low):g} is not below {high} = {getattr(self, high):g}'
                )
        if not self.segments or len(set(self.segments)) < len(self.segments):
            raise ParameterError(
                f'segments = {list(self.segments)} must name at least one segment, each once'
            )
        if self.frequency_max > self.rate / 10.0:
            raise ParameterError(
                f'frequency_max = {self.frequency_max:g} Hz needs at least ten commands a '
                f'period: rate = {self.rate:g} Hz gives {self.rate / self.frequency_max:.2g}'
            )

    def within(self, muscle: Muscle) -> 'Excitation':
        """Return this excitation with the limits of *muscle* applied as well.

        Raises ParameterError if no range is left between them.
        """
        return replace(
            self,
            pressure_max=min(self.pressure_max, muscle.p_max),
            contraction_min=max(self.contraction_min, muscle.kappa_min),
            contraction_max=min(self.contraction_max, muscle.kappa_max),
        )
