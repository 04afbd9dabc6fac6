# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What ``pam_control`` is told for two muscles against each other: as for one, and co-contraction.

Muscles, joint and their effects are declared as to ``pam_sim``, so that one file is for both.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from pam_ros.control.co_contraction import CoContraction
from pam_ros.control.course import Course
from pam_ros.control.limits import Limits
from pam_ros.control.pair_gains import PairGains
from pam_ros.control.pair_law import PairLaw
from pam_ros.control.pair_model import PairModel
from pam_ros.control.pressure_path import PressurePath
from pam_ros.control.shaping import Turn
from pam_ros.errors import ParameterError
from pam_ros.rig.joint_model import JointModel
from pam_ros.settings.control import MEASURED, ControlSettings, Told, build_told, table
from pam_ros.settings.rig import RigParameters
from pam_ros.settings.sim import SimSettings, Start
from pam_ros.settings.tables import Table, Values, build, table_of

NAMES = ('muscles', 'joint_names', 'muscle_topics')  # which pam_sim has, too


def _common() -> Table:
    gains, names = table_of(PairGains, 'gains.'), table_of(SimSettings)
    del gains[f'gains.{MEASURED}']
    kind, default, about = names['muscle_topics']
    text = 'command each muscle on <name>/pressure_command, not all on pressure_commands'
    names['muscle_topics'] = kind, default, replace(about, text=text)
    return {
        **{name: names[name] for name in NAMES},
        **table_of(ControlSettings),
        **table_of(CoContraction),
        **gains,
        **table_of(Limits, 'limits.'),
        **table_of(Turn, 'shape.'),
    }


class PairParameters(RigParameters):
    """The muscles and joints of a rig, one of which is controlled."""

    common: ClassVar[Table] = _common()
    elsewhere: ClassVar[tuple[str, ...]] = tuple(table_of(Start, 'initial.'))

    def build(self, values: dict[str, Any]) -> 'ToldPair':
        """Make of flat *values* what the node works with; PamError where they do not fit."""
        settings = build(ControlSettings, values)
        if settings.controller != 'sliding_mode':
            raise ParameterError(
                f'controller = {settings.controller} is for one muscle: give sliding_mode for '
                f'joint = {settings.joint}'
            )
        k = self._controlled(settings.joint_name)
        if len(self.joints) > 1 and not values['muscle_topics']:
            raise ParameterError(
                f'pressure_commands has all muscles of {len(self.joints)} joints and this is '
                f'the controller of {self.joints[k]} alone: set muscle_topics, here and in pam_sim'
            )
        model = self.models(values)[k]
        assert isinstance(model, JointModel)
        limits = build(Limits, values, 'limits.')
        rig = PairModel(model, limits)
        gains = build(PairGains, values, 'gains.')
        gains = replace(gains, use_measured_velocity=settings.velocity_source == 'measured')
        gains.check(rig, 1.0 / settings.rate)
        told = build(CoContraction, values)
        told.wanted(rig)
        return ToldPair(
            model,
            replace(settings, joint_name=self.joints[k]),
            gains,
            limits,
            build(Turn, values, 'shape.'),
            told,
            rig.reach,
            self.muscles[2 * k : 2 * k + 2],
            bool(values['muscle_topics']),
        )

    def _controlled(self, name: str) -> int:
        """Return which of the joints is controlled."""
        if len(self.joints) == 1:
            return 0
        if name not in self.joints:
            raise ParameterError(
                f'joint_name = {name} is none of the joints {", ".join(self.joints)}: say which '
                'of them is controlled'
            )
        return self.joints.index(name)


@dataclass(frozen=True)
class ToldPair:
    """All that the node was told, checked against each other."""

    model: JointModel
    settings: ControlSettings
    gains: PairGains
    limits: Limits
    shape: Turn
    co_contraction: CoContraction
    reach: tuple[float, float]
    muscles: tuple[str, ...]
    muscle_topics: bool
    unit: ClassVar[str] = 'rad'
    vented: ClassVar[tuple[float, float]] = (0.0, 0.0)  # Pa

    def make_law(self) -> PairLaw:
        """Return a new law, that has to be started."""
        return PairLaw(self.model, self.gains, self.limits, self.co_contraction)

    def make_course(self) -> Course:
        """Return a new course, that has to be started."""
        return Course(self.shape, self.reach, self.unit)

    @property
    def pressure_topics(self) -> tuple[str, ...]:
        """Topics on which the pressure of each muscle is told, the same for all of an array."""
        return tuple(f'{m}/pressure' if self.muscle_topics else 'pressures' for m in self.muscles)

    def command_at(self, chambers: list[float]) -> tuple[float, float]:
        """Return the commands in Pa under which chambers rest at gauge pressures in Pa."""
        muscles = PairModel(self.model, self.limits).muscles
        one, two = (
            PressurePath(muscle, 1.0).command_at_rest(chamber)
            for muscle, chamber in zip(muscles, chambers, strict=True)
        )
        return one, two

    def take_over(self, law: PairLaw, before: 'ToldPair') -> None:
        """Let *law*, which was made as told *before*, go on with other gains and stiffness."""
        if self.gains != before.gains:
            law.set_gains(self.gains)
        if self.co_contraction != before.co_contraction:
            law.set_co_contraction(self.co_contraction)

    def needs_new_law(self, before: 'ToldPair') -> bool:
        """Say whether more than what a law can take while it runs differs from *before*."""
        return (self.model, self.limits) != (before.model, before.limits)


def settings_of(given: Values) -> tuple[Table, Callable[[dict[str, Any]], Told | ToldPair]]:
    """Return the table of all parameters of a controller that is started with *given*.

    And what makes of their values what it works with.
    """
    if given.get('joint') == 'antagonistic':
        parameters = PairParameters(given)
        return parameters.table(), parameters.build
    return table(given), build_told
