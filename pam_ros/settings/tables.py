# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Flat names of parameters, from described dataclasses and from effects, and their values.

These are the names that a ROS node declares: ``mass``, ``sensor.latency``,
``effects.creep.gain``. A table maps each name to its type, default and description. Nodes,
parameter files and command lines share these tables, so that no list of parameters exists twice.
"""

from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from typing import Any, TypeVar

from pam_ros.effects import EFFECTS
from pam_ros.effects.base import ONSET, Effect
from pam_ros.effects.names import GROUP, EffectName, by_effect, parsed
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.parameters import Parameter, described
from pam_ros.rig.arrangements import LOAD, Arrangement
from pam_ros.rig.effect_values import effects_from
from pam_ros.rig.joint import CONTRACTION
from pam_ros.similar_names import similar

Value = bool | int | float | str | tuple[str, ...]
Values = Mapping[str, Value]
Table = dict[str, tuple[type, Any, Parameter]]
T = TypeVar('T')

ORDINALS = ('first', 'second', 'third', 'fourth', 'fifth', 'sixth')


def table_of(cls: type, prefix: str = '', *, revolute: bool = False) -> Table:
    """Return the table of a described dataclass, with *prefix* before each name.

    With *revolute* it is the table for a revolute joint.
    """
    return {prefix + name: entry for name, entry in described(cls, revolute=revolute).items()}


def effects_table(library: tuple[type[Effect], ...] = EFFECTS, *, revolute: bool = False) -> Table:
    """Return the table of all effects: ``effects.<name>.<parameter>``.

    With *revolute* it is the table of effects on a revolute joint.
    """
    return {
        EffectName(effect.name, p.name).flat: (float, p.default, p)
        for effect in library
        for p in (*effect.parameters(revolute=revolute), ONSET)
    }


def muscle_table() -> Table:
    """Return the table of a muscle and of the effects in it."""
    return {
        **table_of(Muscle),
        **effects_table(tuple(effect for effect in EFFECTS if not effect.acts_on_joint())),
    }


def joint_table(kind: Arrangement) -> Table:
    """Return the table of a joint without its muscles, with the effects on it."""
    library = tuple(effect for effect in EFFECTS if effect.acts_on_joint())
    is_revolute = kind.transmission.equations.revolute
    return {
        **table_of(kind.transmission),
        **table_of(kind.load),
        **{name: _contraction(kind, i) for i, name in enumerate(mountings(kind))},
        **effects_table(library, revolute=is_revolute),
    }


def rig_table(kind: Arrangement = LOAD) -> Table:
    """Return the table of all parameters of a joint of this kind, muscles included."""
    return {**muscle_table(), **joint_table(kind)}


def mountings(kind: Arrangement) -> list[str]:
    """Return the names of the parameters that describe the mounting of the muscles."""
    return [f'contraction_{i + 1}' for i in range(kind.muscles)] if kind.has_mounting else []


def _contraction(kind: Arrangement, i: int) -> tuple[type, Any, Parameter]:
    which = f'the {ORDINALS[i]} muscle' if kind.muscles > 1 else 'the muscle'
    place = 'angle' if kind.transmission.equations.revolute else 'position'
    about = replace(CONTRACTION, text=f'contraction of {which} at {place} 0')
    return float, kind.contraction, about


def checked(table: Table, given: Values) -> dict[str, Any]:
    """Return a value for every name of *table*: the given one, checked, or its default.

    Whole numbers become floats if the parameter is a float. Raises a ParameterError that names the
    first value that is not allowed. Given names that the table does not have are left out.
    """
    return {
        name: about.check(name, given[name], kind) if name in given else default
        for name, (kind, default, about) in table.items()
    }


def build(cls: type[T], values: Values, prefix: str = '', **more: Any) -> T:
    """Create a described dataclass from the flat *values* of its fields, and *more* fields."""
    own = {item.name: prefix + item.name for item in fields(cls)}  # type: ignore[arg-type]
    return cls(**{name: values[flat] for name, flat in own.items() if flat in values}, **more)


def effects_of(values: Values) -> dict[str, dict[str, float]]:
    """Return the values of effects among flat *values*; they are checked when they are used."""
    found: dict[str, dict[str, Any]] = by_effect(values)
    return found


def flat(instance: Any, prefix: str = '') -> dict[str, Any]:
    """Return the described fields of a dataclass instance as flat values."""
    return {prefix + name: getattr(instance, name) for name in described(type(instance))}


def with_defaults(table: Table, values: Values) -> Table:
    """Return *table* with *values* as defaults, checked; names that it lacks are ignored."""
    return {
        name: (kind, about.check(name, values[name], kind) if name in values else default, about)
        for name, (kind, default, about) in table.items()
    }


def refuse_mistyped(names: Iterable[str], known: Iterable[str]) -> list[str]:
    """Return those *names* that are not *known*, as they may belong to another program.

    Raises ParameterError for a name so similar to a known name that it must be mistyped.
    """
    known = set(known)
    unknown = [name for name in names if name not in known]
    for name in unknown:
        if alike := similar(name, known):
            raise ParameterError(f'{name} is not a parameter: was {alike} meant?')
    return unknown


def refuse_unknown_effects(values: Values) -> None:
    """Raise ParameterError if *values* name an unknown effect, or an unknown parameter of one.

    No other program has effects, so that their names cannot belong to another program. The values
    of known names are checked when they are used.
    """
    known = effects_table()
    strange = {name: value for name, value in values.items() if name not in known}
    for name in strange:
        if name.partition('.')[0] == GROUP and parsed(name) is None:
            raise ParameterError(
                f'{name} is not a parameter: give {GROUP}.<effect>.<parameter>, such as '
                'effects.payload.mass'
            )
    effects_from(effects_of(strange))


def override(text: str, table: Table) -> tuple[str, Any]:
    """Return the name and the checked value of ``name=value`` on a command line.

    Raises ParameterError if the name does not exist, or if the value is not allowed.
    """
    name, equals, given = (part.strip() for part in text.partition('='))
    if not equals or not given:
        raise ParameterError(f'{text!r} sets nothing: give name=value, such as mass=20')
    if name not in table:
        refuse_mistyped([name], table)
        raise ParameterError(f'{name} is not a parameter: give one such as mass or zeta')
    kind, _, about = table[name]
    value: Value = given
    if kind is bool and given.lower() in ('true', 'false'):
        value = given.lower() == 'true'
    elif kind in (int, float):
        try:
            value = float(given)
        except ValueError:
            value = given
    elif kind is tuple:
        value = listed(given)
    return name, about.check(name, value, kind)


def listed(text: str) -> tuple[str, ...]:
    """Return the names of a list such as ``flexor,extensor`` or ``[flexor, extensor]``."""
    return tuple(part.strip() for part in text.strip('[]').split(',') if part.strip())
