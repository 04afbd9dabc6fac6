# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of ``pam_excite``: the rig, the limits, and the resulting programme."""

from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

from pam_ros.errors import ParameterError
from pam_ros.excitation.programme import Programme, plan, programme
from pam_ros.excitation.settings import Excitation
from pam_ros.parameters import Parameter
from pam_ros.rig.arrangements import LOAD
from pam_ros.rig.joint import Joint
from pam_ros.rig.run import simulate
from pam_ros.settings.braid import BRAID, with_braid
from pam_ros.settings.files import find, read, read_known
from pam_ros.settings.rig import KINDS, RigParameters
from pam_ros.settings.sim import MUSCLE
from pam_ros.settings.tables import Table, Values, build, rig_table, table_of, with_defaults

JOINT: Table = {
    'joint': (
        str,
        LOAD.name,
        Parameter('the joint that is excited: one muscle that moves a mass', choices=(LOAD.name,)),
    )
}


@dataclass(frozen=True)
class Experiment:
    """All settings of the node, and the resulting programme."""

    model: Joint
    settings: Excitation
    programme: Programme

    @property
    def window(self) -> tuple[float, float]:
        """Lowest and highest allowed position in m."""
        l0 = self.model.muscle.l0
        return self.settings.contraction_min * l0, self.settings.contraction_max * l0

    def plan(self) -> str:
        """Return the text that the user should read before the programme starts."""
        low, high = (1e3 * x for x in self.window)
        commands = self.programme
        path = simulate(self.model, commands.t, commands.t, commands.pressure).position
        lines = [
            plan(commands, self.settings),
            f'stops and vents outside {low:.1f} to {high:.1f} mm, and after '
            f'{self.settings.silence:g} s without joint_states',
            f'the nominal model would move from {1e3 * path.min():.1f} to '
            f'{1e3 * path.max():.1f} mm',
        ]
        if path.min() < self.window[0] or path.max() > self.window[1]:
            lines.append('CAUTION: that leaves the window; narrow pressure_min..pressure_max')
        return '\n'.join(lines)


def table(given: Values = MappingProxyType({})) -> Table:
    """Return the table of all parameters; the muscle or braid in *given* sets their defaults.

    None of the parameters can change while the programme is played. Raises ParameterError if they
    describe a joint other than one muscle on a mass.
    """
    _refuse_joint(given)
    live = {**JOINT, **MUSCLE, **BRAID, **rig_table(), **table_of(Excitation)}
    plain: Table = {
        name: (kind, default, replace(about, live=False))
        for name, (kind, default, about) in live.items()
    }
    muscle = given.get('muscle')
    if muscle:
        file = find(str(muscle))
        # Before its names are compared: parameters of a joint would count as mistyped ones.
        _refuse_joint(read(file), f'{file}: ')
    preset = read_known(str(muscle), plain) if muscle else {}
    return with_defaults(plain, with_braid(preset, given, plain))


def _refuse_joint(values: Values, where: str = '') -> None:
    """Raise ParameterError if *values* describe a joint that cannot be excited."""
    joint = values.get('joint', LOAD.name)
    if joint == LOAD.name:
        return
    known = KINDS.get(str(joint))
    what = f' ({known.text})' if known else ''
    raise ParameterError(
        f'{where}joint = {joint}{what} is not allowed: pam_excite excites only one muscle that '
        f'moves a mass (joint = {LOAD.name})'
    )


def experiment(values: dict[str, Any]) -> Experiment:
    """Create an experiment from flat values; raises ParameterError if they are not valid."""
    (model,) = RigParameters({}).build_joints(values)
    settings = build(Excitation, values).within(model.muscle)
    return Experiment(model, settings, programme(settings))
