# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of ``pam_excite``: the rig, the limits, and the resulting programme."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any, ClassVar

import numpy as np

from pam_ros.cached_property import cached_property
from pam_ros.errors import ParameterError
from pam_ros.excitation.guard import spelled
from pam_ros.excitation.programme import Programme, plan, programme
from pam_ros.excitation.settings import Excitation
from pam_ros.rig import statics
from pam_ros.rig.joint import Joint
from pam_ros.rig.run import simulate
from pam_ros.settings.one_joint import MuscleTopics, OneJointParameters
from pam_ros.settings.sim import Start
from pam_ros.settings.tables import Table, Values, build, table_of


@dataclass(frozen=True)
class Experiment:
    """All settings of the node, and the resulting programme."""

    model: Joint
    topics: MuscleTopics
    settings: Excitation
    programme: Programme

    @cached_property
    def window(self) -> tuple[float, float]:
        """Lowest and highest allowed position in m or rad; raises ParameterError if there is none.

        In between the contraction of each muscle is allowed as well.
        """
        s = self.settings
        low, high = s.position_min, s.position_max
        for i in range(len(self.model.muscles)):
            ends = [
                statics.coordinate(self.model, i, kappa)
                for kappa in (s.contraction_min, s.contraction_max)
            ]
            low, high = max(low, min(ends)), min(high, max(ends))
        if low >= high:
            raise ParameterError(
                'no position is within contraction_min to contraction_max of each muscle and '
                f'within position_min to position_max: {s.contraction_min:g} to '
                f'{s.contraction_max:g} of l0, {s.position_min:g} to {s.position_max:g} '
                f'{self.unit}'
            )
        return low, high

    @property
    def unit(self) -> str:
        """Unit of the positions."""
        return self.model.transmission.equations.unit

    def plan(self) -> str:
        """Return the text that the user should read before the programme starts."""
        low, high = self.window
        commands = self.programme
        path = simulate(self.model, commands.t, commands.pressure).position
        least, most = float(path.min()), float(path.max())
        lines = [
            plan(commands, self.settings),
            f'stops and vents outside {spelled(low, high, unit=self.unit)}, and after '
            f'{self.settings.silence:g} s without joint_states',
            f'the nominal model would move from {spelled(least, most, unit=self.unit)}',
        ]
        if least < low or most > high:
            lines.append('CAUTION: that leaves the window; narrow pressure_min..pressure_max')
        return '\n'.join(lines)


class ExciteParameters(OneJointParameters):
    """The muscles and joints of a rig, one of which is excited, and the programme."""

    elsewhere: ClassVar[tuple[str, ...]] = tuple(table_of(Start, 'initial.'))

    @property
    def common(self) -> Table:
        """The table of the common parameters in addition to the rig, in the units of the joint."""
        revolute = self.kind.transmission.equations.revolute
        return {**super().common, **table_of(Excitation, revolute=revolute)}

    def table(self) -> Table:
        """Return the table of all parameters; none of them can change while it is played."""
        return {
            name: (kind, default, replace(about, live=False))
            for name, (kind, default, about) in super().table().items()
        }

    def build(self, values: Values) -> Experiment:
        """Create an experiment from flat *values*; raises ParameterError if they are not valid."""
        settings = build(Excitation, values)
        one = self.one(values, settings.joint_name)
        joint = one.joint.at_start
        settings = reduce(Excitation.within, joint.muscles, settings)
        made = Experiment(joint, one.topics, settings, programme(settings, _sides(joint)))
        _ = made.window  # raises ParameterError
        return made


def _sides(joint: Joint) -> tuple[int, ...]:
    """Return 1 for each muscle that pulls in the direction of the first one, -1 for the others."""
    arms = [float(statics.arm(joint, i, 0.0)) for i in range(len(joint.muscles))]
    return tuple(int(np.sign(arm * arms[0])) for arm in arms)


def settings_of(given: Values) -> tuple[Table, Callable[[dict[str, Any]], Experiment]]:
    """Return the table of all parameters of an excitation that is started with *given*.

    The second value is the function that creates the experiment from their values.
    """
    parameters = ExciteParameters(given)
    return parameters.table(), parameters.build
