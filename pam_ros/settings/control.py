# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of ``pam_control``: the rig, the control law with its gains, rates, timeouts.

Muscles, joints and their effects have the same parameters as in ``pam_sim``, so that one
file can be used for both programs.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from pam_ros.cached_property import cached_property
from pam_ros.control.co_contraction import CoContraction
from pam_ros.control.gains import Gains
from pam_ros.control.joint_settings import described_for
from pam_ros.control.limits import Limits
from pam_ros.control.loop import HOLD, VENT
from pam_ros.control.pid import PidGains
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.setup import LawSetup
from pam_ros.errors import PamError, ParameterError
from pam_ros.parameters import check_all, parameter_field
from pam_ros.settings.one_joint import MuscleTopics, OneJointParameters
from pam_ros.settings.sim import Start
from pam_ros.settings.tables import Table, Values, build, checked, table_of
from pam_ros.sizes import REFERENCE, Sizes, tuned_sizes_of

MEASURED = 'use_measured_velocity'  # the gain that velocity_source sets
LEAST_PERIODS = 3  # of rate for which the rig must at least keep the last command
# s of interruption after which control starts again if command_timeout is 0
LONGEST_INTERRUPTION = 1.0


@dataclass(frozen=True)
class ControlSettings:
    """Law, rates, safety and names of the controller node."""

    controller: str = parameter_field(
        'sliding_mode',
        'control law: sliding_mode, or pid as a baseline',
        choices=('sliding_mode', 'pid'),
    )
    velocity_source: str = parameter_field(
        'estimated',
        'velocity that the law uses: estimated from positions, or measured in joint_states',
        choices=('estimated', 'measured'),
    )
    rate: float = parameter_field(
        500.0,
        'commands per second; with use_sim_time each new joint state is answered instead',
        'Hz',
        low=10.0,
        high=2000.0,
    )
    state_rate: float = parameter_field(
        100.0, 'messages per second on ~/state; 0: none', 'Hz', low=0.0, high=2000.0
    )
    state_timeout: float = parameter_field(
        0.5,  # a loaded machine sometimes delays messages by 0.1 s
        'time without joint_states after which on_timeout acts; until then, control continues '
        'with the model',
        's',
        low=0.005,
        high=3600.0,
    )
    on_timeout: str = parameter_field(
        VENT,
        'what is commanded when joint states stop: vent to 0 Pa, or hold the last pressure',
        choices=(VENT, HOLD),
    )
    vent_time: float = parameter_field(
        2.0,
        'time in which venting lowers any pressure to 0 Pa: by the controller (on_timeout), and '
        'by the rig after command_timeout; 0: at once',
        's',
        low=0.0,
        high=60.0,
    )
    command_timeout: float = parameter_field(
        1.0,
        'time for which the rig keeps the last command before it vents; 0: for ever. If the '
        'controller sends no command for longer (with 0: than 1 s), it starts again from the '
        'present state',
        's',
        low=0.0,
        high=3600.0,
    )
    pressure_wait: float = parameter_field(
        0.5,
        'longest wait for a measured pressure before control begins, so that it begins at that '
        'pressure; 0: measured pressures are not used',
        's',
        low=0.0,
        high=60.0,
        live=False,
    )
    ambient_pressure: float = parameter_field(
        101325.0,
        'absolute pressure around the muscle, subtracted from measured pressures',
        'Pa',
        low=0.0,
        high=2e5,
    )
    start_enabled: bool = parameter_field(
        True, 'whether control starts at once; false: at a call of ~/enable', live=False
    )
    joint_name: str = parameter_field('pam', 'name of the joint in joint_states', live=False)

    def __post_init__(self) -> None:
        """Check every field, then command_timeout against rate."""
        check_all(self)
        if 0.0 < self.command_timeout * self.rate < LEAST_PERIODS:
            raise ParameterError(
                f'command_timeout {self.command_timeout:g} s is less than {LEAST_PERIODS} periods '
                f'of rate {self.rate:g} Hz: the rig would not wait for the next command'
            )

    @property
    def longest_interruption(self) -> float:
        """Duration in s of an interruption of the controller after which control starts again."""
        return self.command_timeout or LONGEST_INTERRUPTION

    @property
    def interruption_limit(self) -> str:
        """This limit as text; command_timeout 0 means that the rig has no timeout."""
        name = 'command_timeout' if self.command_timeout else 'permitted with command_timeout 0'
        return f'{name} ({self.longest_interruption:g} s)'


class _ControlledRig(OneJointParameters):
    """The muscles and joints of a rig, one of which is controlled."""

    elsewhere: ClassVar[tuple[str, ...]] = tuple(table_of(Start, 'initial.'))


class ControlParameters(_ControlledRig):
    """The parameters of such a rig and of its controller."""

    @cached_property
    def _sizes(self) -> Sizes:
        """The sizes of the joint with the values that were given at the start."""
        try:
            rig = _ControlledRig(self._given)
            name = str(self._given.get('joint_name', ControlSettings.joint_name))
            joint = rig.one(checked(rig.table(), self._given), name).joint
        except PamError:  # they are refused where they are used
            return REFERENCE
        return tuned_sizes_of(joint)

    @property
    def common(self) -> Table:
        """The table of the common parameters in addition to the rig, in the units of the joint."""
        revolute = self.kind.transmission.equations.revolute

        def sized(cls: type, prefix: str = '') -> Table:
            found = described_for(cls, self._sizes, revolute=revolute)
            return {prefix + name: entry for name, entry in found.items()}

        gains = sized(Gains, 'gains.')
        can_stiffen = revolute and self.kind.muscles > 1
        del gains[f'gains.{MEASURED}']
        return {
            **super().common,
            **table_of(ControlSettings),
            **(sized(CoContraction) if can_stiffen else {}),
            **gains,
            **sized(PidGains, 'pid.'),
            **table_of(Limits, 'limits.'),
            **sized(Shape, 'shape.'),
        }

    def build(self, values: Values) -> 'ControlSetup':
        """Create the setup of the node from flat *values*; raises PamError if they are invalid."""
        settings = build(ControlSettings, values)
        one = self.one(values, settings.joint_name)
        settings = replace(settings, joint_name=one.name)
        joint = one.joint.at_start
        is_revolute = joint.is_revolute
        gains = replace(
            build(Gains, values, 'gains.', is_revolute=is_revolute),
            use_measured_velocity=settings.velocity_source == 'measured',
        )
        pid = build(PidGains, values, 'pid.', is_revolute=is_revolute)
        limits = build(Limits, values, 'limits.')
        shape = build(Shape, values, 'shape.', is_revolute=is_revolute)
        co_contraction = build(CoContraction, values)
        law = LawSetup(
            *(settings.controller, joint, gains, pid, limits, shape, co_contraction),
            period=1.0 / settings.rate,
        )
        return ControlSetup(settings, law, one.topics)


@dataclass(frozen=True)
class ControlSetup:
    """All settings of the node, checked against each other."""

    settings: ControlSettings
    law: LawSetup
    topics: MuscleTopics


def settings_of(given: Values) -> tuple[Table, Callable[[dict[str, Any]], ControlSetup]]:
    """Return the table of all parameters of a controller that is started with *given*.

    The second value is the function that creates the setup of the node from their values.
    """
    parameters = ControlParameters(given)
    return parameters.table(), parameters.build
