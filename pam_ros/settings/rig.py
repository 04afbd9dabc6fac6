# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which muscles and joints there are, and which parameters each of them has.

A parameter without a name before it is everybody's; ``<name>.<parameter>`` is that of one muscle
or joint alone. A name has those of its own that it was given at the start, itself or by a preset
``<name>.muscle``; in all else it follows what is everybody's.
"""

import re
from functools import cached_property
from itertools import chain
from typing import Any, ClassVar

from pam_ros.effects import EFFECTS
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.assembly import Model
from pam_ros.rig.joint_model import Actuator, JointModel
from pam_ros.rig.joints import antagonistic_pair, parallel
from pam_ros.rig.joints.base import Joint, acts_in_muscle, acts_on_load
from pam_ros.settings.files import read_known
from pam_ros.settings.sim import MUSCLE, SimSettings
from pam_ros.settings.tables import (
    Table,
    Values,
    build,
    build_rig,
    effects_table,
    refuse_mistyped,
    rig_table,
    table_of,
    with_defaults,
)

PAIRS: dict[str, Joint] = {'antagonistic': antagonistic_pair.JOINT, 'parallel': parallel.JOINT}
NAME = re.compile(r'[A-Za-z][A-Za-z0-9_]*')


def _lists(value: Any) -> tuple[str, ...]:
    is_list = isinstance(value, list | tuple) and all(isinstance(name, str) for name in value)
    return tuple(value) if is_list else ()


class RigParameters:
    """The names of muscles and joints, and which parameters each of them can have.

    *given* are the parameters that the node was started with. ``common`` are those that are
    everybody's beside the rig; of ``start`` each muscle has what begins with its pressure, and
    each joint the rest. ``elsewhere`` are names that another program knows. Raises ParameterError
    where the names do not go together, or a parameter given to one of them is none of its own.
    """

    common: ClassVar[Table] = {}
    start: ClassVar[Table] = {}
    elsewhere: ClassVar[tuple[str, ...]] = ()

    def __init__(self, given: Values) -> None:
        """Look at what is given; the values are checked later."""
        self.pair = PAIRS.get(str(given.get('joint', 'load')))
        self._given = given
        per_joint = self.pair.muscles if self.pair else 1
        alone = str(given.get('joint_name', SimSettings.joint_name))
        self.muscles = _lists(given.get('muscles')) or self._names(alone, per_joint)
        if len(self.muscles) % per_joint:
            raise ParameterError(
                f'muscles: {len(self.muscles)} names make no joint = {given["joint"]}: give '
                f'{per_joint} for each joint'
            )
        count = len(self.muscles) // per_joint
        self.joints = _lists(given.get('joint_names')) or (
            self._names(alone, count) if self.pair or not given.get('muscles') else self.muscles
        )
        if len(self.joints) != count:
            raise ParameterError(
                f'joint_names: {len(self.joints)} names for {count} joints: give one each'
            )
        self._check_names()

    @staticmethod
    def _names(stem: str, count: int) -> tuple[str, ...]:
        return (stem,) if count == 1 else tuple(f'{stem}_{i + 1}' for i in range(count))

    def _check_names(self) -> None:
        taken = {name.partition('.')[0] for name in self.base()}
        for kind, names in (('muscles', self.muscles), ('joint_names', self.joints)):
            for i, name in enumerate(names):
                if name in names[:i]:
                    raise ParameterError(f'{kind}: {name} is named twice')
                # What nobody named is not told from others by its name.
                if not self._given.get(kind):
                    continue
                if not NAME.fullmatch(name) or '__' in name or name.endswith('_'):
                    raise ParameterError(
                        f'{kind}: {name!r} is no name: give letters, digits and single _'
                    )
                if name in taken:
                    raise ParameterError(f'{kind}: {name} is the name of a parameter')

    # Tables ----------------------------------------------------------------------------------

    def _load(self) -> Table:
        """Return the table of a joint's load, with the effects on it."""
        assert self.pair
        library = tuple(self.pair.on_load(e) for e in EFFECTS if acts_on_load(e))
        return {**table_of(self.pair.declared), **effects_table(library)}

    def _actuator(self) -> Table:
        """Return the table of a muscle in a joint, with the effects in it."""
        return {
            **table_of(Muscle),
            **effects_table(tuple(e for e in EFFECTS if acts_in_muscle(e))),
        }

    def _own(self, name: str) -> Table:
        """Return the table of all that the muscle or joint *name* can have of its own."""
        if self.pair is None:
            return self._alone
        own: Table = {}
        if name in self.muscles:
            own |= self._of_muscle
        if name in self.joints:
            own |= self._of_joint
        return own

    @cached_property
    def _alone(self) -> Table:
        return {**MUSCLE, **rig_table(), **self.start}

    @cached_property
    def _of_muscle(self) -> Table:
        start = {flat: about for flat, about in self.start.items() if flat.endswith('.pressure')}
        return {**MUSCLE, **self._actuator(), **start}

    @cached_property
    def _of_joint(self) -> Table:
        return {
            **self._load(),
            **{k: v for k, v in self.start.items() if k not in self._of_muscle},
        }

    def base(self) -> Table:
        """Return the table of the parameters that are everybody's."""
        plain = {
            **MUSCLE,
            **({**self._actuator(), **self._load()} if self.pair else rig_table()),
            **self.common,
            **self.start,
        }
        return with_defaults(plain, self._preset(self._given, plain))

    def _preset(self, given: Values, known: Table) -> Values:
        """Return what a preset says: for a pair of muscles nothing of the load."""
        if not given.get('muscle'):
            return {}
        values = read_known(str(given['muscle']), known)
        here = self._actuator() if self.pair else known
        return {name: value for name, value in values.items() if name in here}

    def table(self) -> Table:
        """Return the table of everybody's parameters and of each name's own."""
        names = dict.fromkeys(chain(self.muscles, self.joints))
        own: dict[str, dict[str, Any]] = {}
        for flat, value in self._given.items():
            name, dot, rest = flat.partition('.')
            if dot and name in names:
                own.setdefault(name, {})[rest] = value
        table = self.base()
        for name, told in own.items():
            known = self._own(name)
            given = {rest: value for rest, value in told.items() if rest not in self.elsewhere}
            all_known = {f'{name}.{rest}' for rest in known}
            for stranger in refuse_mistyped((f'{name}.{rest}' for rest in given), all_known):
                raise ParameterError(f'{stranger}: {name} has no parameter of this name')
            preset = self._preset(given, known)
            known = with_defaults(known, preset)
            table |= {f'{name}.{rest}': known[rest] for rest in chain(preset, given)}
        return table

    # Models ----------------------------------------------------------------------------------

    def of(self, values: Values, name: str) -> dict[str, Any]:
        """Return the values of one name: its own, or everybody's."""
        own = ((rest, f'{name}.{rest}') for rest in self._own(name))
        return {rest: values[flat] if flat in values else values[rest] for rest, flat in own}

    def models(self, values: Values) -> tuple[Model, ...]:
        """Make the joints of checked flat *values*; ParameterError where they make none."""
        if self.pair is None:
            # Muscles that are told the same are the same: most of many are.
            made: dict[tuple[Any, ...], Model] = {}
            found = []
            for name in self.joints:
                own = self.of(values, name)
                key = tuple(own.values())
                if key not in made:
                    made[key] = build_rig(own)
                found.append(made[key])
            return tuple(found)
        per_joint = self.pair.muscles
        acting = [self.of(values, name) for name in self.muscles]
        actuators = [Actuator(build(Muscle, own), _effects(own, acts_in_muscle)) for own in acting]
        loads = [self.of(values, name) for name in self.joints]
        return tuple(
            JointModel(
                build(self.pair.declared, own),
                tuple(actuators[k * per_joint : (k + 1) * per_joint]),
                _effects(own, acts_on_load),
            )
            for k, own in enumerate(loads)
        )


def _effects(values: Values, is_here: Any) -> dict[str, dict[str, float]]:
    """Return the effects of a muscle or of a load among flat *values*."""
    return {
        effect.name: {
            p.name: values[f'effects.{effect.name}.{p.name}']  # type: ignore[misc]
            for p in effect.parameters
        }
        for effect in EFFECTS
        if is_here(effect)
    }
