# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What ``pam_control`` is told: the rig, the law's gains, limits, rates, names."""

from dataclasses import dataclass
from typing import Any

from pam_ros.config import Table, build, build_rig, rig_table, table_of, with_defaults
from pam_ros.control.course import Course
from pam_ros.control.gains import Gains
from pam_ros.control.limits import Limits, reachable
from pam_ros.control.loop import HOLD, VENT
from pam_ros.control.pid import Pid, PidGains
from pam_ros.control.shaping import Shape
from pam_ros.control.signals import PositionLaw
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.nodes.sim_settings import MUSCLE
from pam_ros.parameter_files import read_known
from pam_ros.parameters import check_all, parameter
from pam_ros.rig.model import RigModel

SLIDING_MODE, PID = 'sliding_mode', 'pid'


@dataclass(frozen=True)
class ControlSettings:
    """Rates, safety and names of the controller node."""

    control_rate: float = parameter(
        500.0, 'pressure commands per second', 'Hz', low=20.0, high=5000.0, live=False
    )
    law: str = parameter(SLIDING_MODE, 'position law', choices=(SLIDING_MODE, PID), live=False)
    enabled: bool = parameter(True, 'whether it commands from the start', live=False)
    joint_name: str = parameter(
        '', 'joint in joint_states; empty: the only one there is', live=False
    )
    state_timeout: float = parameter(
        0.1,
        'age of the newest joint state at which on_timeout acts',
        's',
        low=0.001,
        high=60.0,
    )
    on_timeout: str = parameter(
        HOLD,
        'what is commanded when joint states stay away: hold the last pressure, or vent to 0 Pa',
        choices=(HOLD, VENT),
    )
    state_rate: float = parameter(
        100.0, 'messages per second on ~/state', 'Hz', low=0.1, high=5000.0
    )
    ambient_pressure: float = parameter(
        101325.0,
        'absolute pressure around the muscle, taken off what comes on the topic pressure',
        'Pa',
        low=0.0,
        high=1e6,
    )

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self)


@dataclass(frozen=True)
class Control:
    """All that the node is told, checked together."""

    model: RigModel
    gains: Gains
    pid: PidGains
    limits: Limits
    shape: Shape
    settings: ControlSettings

    def __post_init__(self) -> None:
        """Refuse gains that do not suit the rig, and a rig that cannot be held anywhere."""
        self.gains.check(self.model, self.period)
        reachable(self.model, self.limits)

    @property
    def period(self) -> float:
        """Time in s from one command to the next."""
        return 1.0 / self.settings.control_rate

    def law(self) -> PositionLaw:
        """Return a new law."""
        if self.settings.law == PID:
            return Pid(self.model, self.pid, self.limits)
        return SlidingMode(self.model, self.gains, self.limits)

    def course(self) -> Course:
        """Return a new course."""
        return Course(self.shape, reachable(self.model, self.limits))

    def needs_new_law(self, before: 'Control') -> bool:
        """Say whether more than what a law can take while it runs differs from *before*."""
        return (self.model, self.pid, self.limits) != (before.model, before.pid, before.limits)


def table(muscle: Any = '') -> Table:
    """Return the table of all parameters; their defaults come from *muscle* where it is given."""
    plain: Table = {
        **MUSCLE,
        **rig_table(),
        **table_of(ControlSettings),
        **table_of(Limits),
        **table_of(Shape, 'reference.'),
        **table_of(Gains, 'gains.'),
        **table_of(PidGains, 'pid.'),
    }
    return with_defaults(plain, read_known(str(muscle), plain)) if muscle else plain


def control(values: dict[str, Any]) -> Control:
    """Make a controller's settings from flat values; raises ParameterError where they are none."""
    return Control(
        build_rig(values),
        build(Gains, values, 'gains.'),
        build(PidGains, values, 'pid.'),
        build(Limits, values),
        build(Shape, values, 'reference.'),
        build(ControlSettings, values),
    )
