# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What ``pam_control`` is told for one muscle: rig, law with its gains, rates and time-outs."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar

from pam_ros.control.course import Course
from pam_ros.control.gains import Gains
from pam_ros.control.limits import Limits, reachable
from pam_ros.control.loop import HOLD, VENT
from pam_ros.control.pid import Pid, PidGains
from pam_ros.control.pressure_path import PressurePath
from pam_ros.control.shaping import Shape
from pam_ros.control.signals import PositionLaw
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.parameters import check_all, parameter
from pam_ros.rig.model import RigModel
from pam_ros.settings.files import read_known
from pam_ros.settings.sim import MUSCLE
from pam_ros.settings.tables import (
    Table,
    Values,
    build,
    build_rig,
    rig_table,
    table_of,
    with_defaults,
)

MEASURED = 'use_measured_velocity'  # a gain that velocity_source stands for


@dataclass(frozen=True)
class ControlSettings:
    """Law, rates, safety and names of the controller node."""

    controller: str = parameter(
        'sliding_mode',
        'law that controls: sliding_mode, or pid as a baseline (needs simple-pid)',
        choices=('sliding_mode', 'pid'),
    )
    velocity_source: str = parameter(
        'estimated',
        'where the law has its velocity from: estimated from positions, or measured in '
        'joint_states',
        choices=('estimated', 'measured'),
    )
    rate: float = parameter(
        500.0,
        'commands per second; with use_sim_time each new joint state is answered instead',
        'Hz',
        low=10.0,
        high=2000.0,
    )
    state_rate: float = parameter(
        100.0, 'messages per second on ~/state; 0: none', 'Hz', low=0.0, high=2000.0
    )
    state_timeout: float = parameter(
        0.1,
        'silence of joint_states after which on_timeout acts',
        's',
        low=0.005,
        high=3600.0,
    )
    on_timeout: str = parameter(
        VENT,
        'what is commanded when joint states stay away: vent to 0 Pa, or hold the last pressure',
        choices=(VENT, HOLD),
    )
    pressure_wait: float = parameter(
        0.5,
        'longest wait for a measured pressure before control begins, so that it begins at that '
        'pressure; 0: none is asked for',
        's',
        low=0.0,
        high=60.0,
        live=False,
    )
    ambient_pressure: float = parameter(
        101325.0,
        'pressure around the muscle, which measured ones include',
        'Pa',
        low=0.0,
        high=2e5,
    )
    start_enabled: bool = parameter(
        True, 'whether it controls from the start; false: from ~/enable on', live=False
    )
    joint: str = parameter(
        'load',
        'load: one muscle moves a load; antagonistic: two muscles turn a pulley against each '
        'other, and the angle is controlled',
        choices=('load', 'antagonistic'),
        live=False,
    )
    joint_name: str = parameter('pam', 'name of the joint in joint_states', live=False)

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self)


@dataclass(frozen=True)
class Told:
    """All that the node was told, checked against each other."""

    model: RigModel
    settings: ControlSettings
    gains: Gains
    pid: PidGains
    limits: Limits
    shape: Shape
    reach: tuple[float, float]
    unit: ClassVar[str] = 'm'
    vented: ClassVar[float] = 0.0  # Pa
    pressure_topics: ClassVar[tuple[str, ...]] = ('pressure',)

    def make_law(self) -> PositionLaw[float]:
        """Return a new law, that has to be started."""
        if self.settings.controller == 'pid':
            return Pid(self.model, self.pid, self.limits)
        return SlidingMode(self.model, self.gains, self.limits)

    def make_course(self) -> Course:
        """Return a new course, that has to be started."""
        return Course(self.shape, self.reach)

    def command_at(self, chambers: list[float]) -> float:
        """Return the command in Pa under which the chamber rests at a gauge pressure in Pa."""
        return PressurePath(self.model, 1.0).command_at_rest(chambers[0])

    def take_over(self, law: PositionLaw[float], before: 'Told') -> None:
        """Let *law*, which was made as told *before*, go on with other gains."""
        if isinstance(law, SlidingMode) and self.gains != before.gains:
            law.set_gains(self.gains)

    def needs_new_law(self, before: 'Told') -> bool:
        """Say whether more than what a law can take while it runs differs from *before*."""
        return (self.settings.controller, self.model, self.pid, self.limits) != (
            *(before.settings.controller, before.model, before.pid, before.limits),
        )


def table(given: Values) -> Table:
    """Return the table of all parameters, those of the muscle that is *given* as its defaults."""
    gains = table_of(Gains, 'gains.')
    del gains[f'gains.{MEASURED}']
    plain: Table = {
        **MUSCLE,
        **rig_table(),
        **table_of(ControlSettings),
        **gains,
        **table_of(PidGains, 'pid.'),
        **table_of(Limits, 'limits.'),
        **table_of(Shape, 'shape.'),
    }
    name = given.get('muscle', '')
    return with_defaults(plain, read_known(str(name), plain)) if name else plain


def build_told(values: dict[str, Any]) -> Told:
    """Make of flat *values* what the node works with; raises PamError where they do not fit."""
    model = build_rig(values)
    settings = build(ControlSettings, values)
    gains = build(Gains, values, 'gains.')
    gains = replace(gains, use_measured_velocity=settings.velocity_source == 'measured')
    limits = build(Limits, values, 'limits.')
    gains.check(model, 1.0 / settings.rate)
    told = Told(
        model,
        settings,
        gains,
        build(PidGains, values, 'pid.'),
        limits,
        build(Shape, values, 'shape.'),
        reachable(model, limits),
    )
    told.make_law()  # which says what it lacks
    return told
