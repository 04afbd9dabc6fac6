# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Flat parameter names: from described dataclasses and effects, and back to a model.

A name is what a ROS node declares: ``mass``, ``sensor.latency``, ``effects.creep.gain``. A table
maps each to its type, default and description. Nodes, parameter files and command lines
share these tables, so that no list of parameters exists twice.
"""

from collections.abc import Iterable, Mapping
from dataclasses import fields
from difflib import get_close_matches
from typing import Any, TypeVar

from pam_ros.effects import EFFECTS
from pam_ros.effects.base import Effect
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.parameters import Parameter, described
from pam_ros.rig.model import Load, RigModel

Value = bool | int | float | str | tuple[str, ...]
Values = Mapping[str, Value]
Table = dict[str, tuple[type, Any, Parameter]]
T = TypeVar('T')

ALIKE = 0.8  # likeness from which an unknown name is taken for a mistyped one


def table_of(cls: type, prefix: str = '') -> Table:
    """Return the table of a described dataclass, each name led by *prefix*."""
    return {prefix + name: entry for name, entry in described(cls).items()}


def effects_table(library: tuple[Effect, ...] = EFFECTS) -> Table:
    """Return the table of all effects: ``effects.<name>.<parameter>``."""
    return {
        f'effects.{effect.name}.{p.name}': (float, p.default, p.described())
        for effect in library
        for p in effect.parameters
    }


def rig_table() -> Table:
    """Return the table of everything that a :class:`RigModel` is made of."""
    return {**table_of(Muscle), **table_of(Load), **effects_table()}


def checked(table: Table, given: Values) -> dict[str, Any]:
    """Return a value for every name of *table*: the given one, checked, or its default.

    Whole numbers become floats where a float is wanted. Raises ParameterError naming the first
    value that is not allowed. Given names that the table does not have are left out.
    """
    return {
        name: about.check(name, given[name], kind) if name in given else default
        for name, (kind, default, about) in table.items()
    }


def build(cls: type[T], values: Values, prefix: str = '') -> T:
    """Make a described dataclass from those flat *values* that are its own."""
    own = {item.name: prefix + item.name for item in fields(cls)}  # type: ignore[arg-type]
    return cls(**{name: values[flat] for name, flat in own.items() if flat in values})


def build_rig(values: Values) -> RigModel:
    """Make the rig from flat *values*; what is not given has its default.

    Names that belong to something else are passed over; raises ParameterError where the values
    make no rig.
    """
    effects: dict[str, dict[str, float]] = {}
    for name, value in values.items():
        kind, _, rest = name.partition('.')
        effect, _, which = rest.partition('.')
        if kind == 'effects':
            effects.setdefault(effect, {})[which] = value  # type: ignore[assignment]
    return RigModel(build(Muscle, values), build(Load, values), effects)


def flat(instance: Any, prefix: str = '') -> dict[str, Any]:
    """Return the described fields of a dataclass instance as flat values."""
    return {prefix + name: getattr(instance, name) for name in described(type(instance))}


def flat_rig(model: RigModel) -> dict[str, Any]:
    """Return the flat values of a rig: muscle, load, and the effects that it was given."""
    values = {**flat(model.muscle), **flat(model.load)}
    for effect, given in model.effects.items():
        values.update({f'effects.{effect}.{name}': value for name, value in given.items()})
    return values


def with_defaults(table: Table, values: Values) -> Table:
    """Return *table* with those of *values* that it has as its defaults, checked."""
    return {
        name: (kind, about.check(name, values[name], kind) if name in values else default, about)
        for name, (kind, default, about) in table.items()
    }


def refuse_mistyped(names: Iterable[str], known: Iterable[str]) -> list[str]:
    """Return those *names* that are not *known*, as they may belong to another program.

    Raises ParameterError for one that is so like a known name that it must be a slip.
    """
    known = set(known)
    strangers = [name for name in names if name not in known]
    for name in strangers:
        alike = get_close_matches(name, known, n=1, cutoff=ALIKE)
        if alike:
            raise ParameterError(f'{name} is not a parameter: was {alike[0]} meant?')
    return strangers


def override(text: str, table: Table) -> tuple[str, Any]:
    """Return name and checked value of a command line's ``name=value``.

    Raises ParameterError where there is no such name, or the value is not allowed.
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
    return name, about.check(name, value, kind)
