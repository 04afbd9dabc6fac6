# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The muscles and joints of a rig: their names, their parameters, and joints built from these.

All joints that a file or a program describes are created here from flat values.

A parameter without a name before it is common to all muscles and joints;
``<name>.<parameter>`` belongs to one muscle or joint only. A muscle or joint has its own values
of those parameters that were given for it at the start, directly or by a preset
``<name>.muscle``; for all other parameters it has the common values.
"""

import re
from collections.abc import Iterable, Sequence
from itertools import chain
from typing import Any, ClassVar

from pam_ros.cached_property import cached_property
from pam_ros.effects.base import Effect
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.arrangements import ARRANGEMENTS, LOAD
from pam_ros.rig.effect_values import effects_from, split_effects
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.settings.braid import BRAID, LIMITS, NAMES, with_braid
from pam_ros.settings.files import read_known
from pam_ros.settings.sim import MUSCLE, SimSettings
from pam_ros.settings.tables import (
    Table,
    Values,
    build,
    effects_of,
    joint_table,
    mountings,
    muscle_table,
    refuse_mistyped,
    refuse_unknown_effects,
    with_defaults,
)

KINDS = {kind.name: kind for kind in ARRANGEMENTS}
NAME = re.compile(r'[A-Za-z][A-Za-z0-9_]*')


def _lists(value: Any) -> tuple[str, ...]:
    is_list = isinstance(value, list | tuple) and all(isinstance(name, str) for name in value)
    return tuple(value) if is_list else ()


class RigParameters:
    """The names of muscles and joints, and the parameters that each of them can have.

    *given* are the parameters that the node was started with. ``start`` is the table of the
    initial state: the pressure belongs to each muscle, the rest to each joint. ``elsewhere`` are
    parameters of another program, which are ignored. Raises ParameterError if a name is not
    valid, if the number of names does not fit the kind of joint, or if a parameter given for one
    of them does not exist.
    """

    start: ClassVar[Table] = {}
    elsewhere: ClassVar[tuple[str, ...]] = ()

    @property
    def common(self) -> Table:
        """The table of the common parameters in addition to those of the rig."""
        return {}

    def __init__(self, given: Values) -> None:
        """Read the names among the *given* parameters; the values are checked later."""
        refuse_unknown_effects(given)
        self.kind = KINDS.get(str(given.get('joint', LOAD.name)), LOAD)
        self._given = given
        per_joint = self.kind.muscles
        alone = str(given.get('joint_name') or SimSettings.joint_name)
        self.muscles = _lists(given.get('muscles')) or self._names(alone, per_joint)
        if len(self.muscles) % per_joint:
            raise ParameterError(
                f'muscles: {len(self.muscles)} names do not fit joint = {self.kind.name}: give '
                f'{per_joint} for each joint'
            )
        count = len(self.muscles) // per_joint
        # If only the muscles are named, a joint with one muscle has the name of this muscle.
        is_own = per_joint == 1 and bool(given.get('muscles'))
        self.joints = _lists(given.get('joint_names')) or (
            self.muscles if is_own else self._names(alone, count)
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
                # Names that are not given are generated here and need no check.
                if not self._given.get(kind):
                    continue
                if not NAME.fullmatch(name) or '__' in name or name.endswith('_'):
                    raise ParameterError(
                        f'{kind}: {name!r} is not a valid name: give letters, digits and single _'
                    )
                if name in taken:
                    raise ParameterError(f'{kind}: {name} is the name of a parameter')

    # Tables ----------------------------------------------------------------------------------

    @cached_property
    def _of_muscle(self) -> Table:
        """The table of the parameters that a muscle can have of its own."""
        start = {flat: about for flat, about in self.start.items() if flat.endswith('.pressure')}
        return {**MUSCLE, **BRAID, **muscle_table(), **start}

    @cached_property
    def _of_joint(self) -> Table:
        """The table of the parameters that a joint, without its muscles, can have of its own."""
        start = {k: about for k, about in self.start.items() if k not in self._of_muscle}
        return {**joint_table(self.kind), **start}

    def _own(self, name: str) -> Table:
        """Return the table of the parameters that a muscle or joint *name* can have of its own."""
        is_both = self.kind.muscles == 1  # each name means both the muscle and its joint
        return {
            **(self._of_muscle if is_both or name in self.muscles else {}),
            **(self._of_joint if is_both or name in self.joints else {}),
        }

    def base(self) -> Table:
        """Return the table of the common parameters."""
        plain = {
            **MUSCLE,
            **BRAID,
            **muscle_table(),
            **joint_table(self.kind),
            **self.common,
            **self.start,
        }
        preset = self._preset(self._given, plain)
        return with_defaults(plain, with_braid(preset, self._given, plain))

    def _preset(self, given: Values, known: Table) -> dict[str, Any]:
        """Return the values of a preset; those of the load only for one muscle on a mass."""
        if not given.get('muscle'):
            return {}
        values = read_known(str(given['muscle']), known)
        here = known if self.kind is LOAD else {**BRAID, **muscle_table()}
        return {name: value for name, value in values.items() if name in here}

    def table(self) -> Table:
        """Return the table of the common parameters and of the own parameters of each name."""
        names = dict.fromkeys(chain(self.muscles, self.joints))
        own: dict[str, dict[str, Any]] = {}
        for flat, value in self._given.items():
            name, dot, rest = flat.partition('.')
            if dot and name in names:
                own.setdefault(name, {})[rest] = value
        table = self.base()
        for name, values in own.items():
            known = self._own(name)
            given = {rest: value for rest, value in values.items() if rest not in self.elsewhere}
            all_known = {f'{name}.{rest}' for rest in known}
            for unknown in refuse_mistyped((f'{name}.{rest}' for rest in given), all_known):
                raise ParameterError(f'{unknown}: {name} has no parameter of this name')
            common = {flat: self._given.get(flat, table[flat][1]) for flat in (*NAMES, *LIMITS)}
            preset = with_braid(self._preset(given, known), given, known, common)
            known = with_defaults(known, preset)
            table |= {f'{name}.{rest}': known[rest] for rest in chain(preset, given)}
        return table

    # Joints ----------------------------------------------------------------------------------

    def of_muscle(self, values: Values, i: int) -> dict[str, Any]:
        """Return the values given for muscle number i: its own, or the common ones."""
        names = [self.muscles[i]]
        if self.kind.muscles == 1:
            names.append(self.joints[i])
        return _found(values, self._of_muscle, names)

    def of_joint(self, values: Values, k: int) -> dict[str, Any]:
        """Return the values given for joint number k without its muscles: own or common ones."""
        names = [self.joints[k]]
        if self.kind.muscles == 1:
            names.append(self.muscles[k])
        return _found(values, self._of_joint, names)

    def build_joints(self, values: Values) -> tuple[Joint, ...]:
        """Create the joints from flat *values*; raises ParameterError if they are not valid.

        A parameter that is not given has its default.
        """
        n = self.kind.muscles
        # Joints with the same values are one object: in a large rig most joints are equal.
        made: dict[tuple[Any, ...], Joint] = {}
        found = []
        for k in range(len(self.joints)):
            muscles = [self.of_muscle(values, i) for i in range(n * k, n * (k + 1))]
            joint = self.of_joint(values, k)
            key = tuple(tuple(own.items()) for own in (*muscles, joint))
            if key not in made:
                made[key] = self._build(muscles, joint)
            found.append(made[key])
        return tuple(found)

    def build_common(self, values: Values) -> Joint:
        """Create a joint from those flat *values* that are common to all joints."""
        return self._build([values] * self.kind.muscles, values)

    def _build(self, muscles: Sequence[Values], joint: Values) -> Joint:
        """Create a joint from the values of each muscle, and from those of the joint itself.

        Names that belong to something else are ignored. The same applies to effects: each muscle
        and the joint use only those that act in them.
        """
        kind = self.kind
        contractions: list[Any] = [joint.get(n, kind.contraction) for n in mountings(kind)]
        actuators = tuple(
            Actuator(build(Muscle, own), _effects(own)[0], contraction)
            for own, contraction in zip(muscles, contractions or [0.0], strict=True)
        )
        return Joint(
            actuators,
            build(kind.load, joint),
            build(kind.transmission, joint),
            _effects(joint)[1],
        )


def _found(values: Values, table: Table, names: Iterable[str]) -> dict[str, Any]:
    """Return the values for *table*.

    For each parameter it is the value of the first of *names* with its own, else the common one.
    """
    found = {}
    for rest in table:
        for flat in (*(f'{name}.{rest}' for name in names), rest):
            if flat in values:
                found[rest] = values[flat]
                break
    return found


def _effects(values: Values) -> tuple[tuple[Effect, ...], tuple[Effect, ...]]:
    """Return the effects among flat *values*: those in a muscle, and those on the joint."""
    return split_effects(effects_from(effects_of(values)))
