# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters ``braid.*``: a self-made McKibben muscle described by its geometry.

They act like a preset: they determine a1..a6, their units, the inside diameter, the rated force
and the source. A parameter that is given in addition to them overrides their value.
"""

from dataclasses import fields, replace
from typing import Any

from pam_ros.errors import ParameterError
from pam_ros.muscle.braid import Braid
from pam_ros.muscle.constants import CONSTANTS, from_si
from pam_ros.parameters import described
from pam_ros.settings.tables import Table, Values, table_of

PREFIX = 'braid.'
ANGLE = f'{PREFIX}angle'
NAMES = tuple(PREFIX + item.name for item in fields(Braid))
UNITS = ('pressure_unit', 'contraction_unit')
LIMITS = ('p_max', 'kappa_min', 'kappa_max')
FOLLOWING = (*CONSTANTS, *UNITS, 'inside_diameter', 'force_max', 'source')  # from a braid


def _table() -> Table:
    """Return the table of the braid; by default its angle is 0, which means no braid."""
    kind, _, about = described(Braid)['angle']
    text = f'{about.text}; 0: a1 to a6 are given, not the geometry'
    return {**table_of(Braid, PREFIX), ANGLE: (kind, 0.0, replace(about, text=text, low=0.0))}


BRAID = _table()


def with_braid(
    preset: Values, given: Values, table: Table, common: Values | None = None
) -> dict[str, Any]:
    """Return *preset* with the values of the braid that *preset* or *given* describes.

    *given* are flat parameters. They override the values of the braid, and so do the parameters
    of a preset that describes the braid itself. *common* are the values that apply if neither
    *given* nor *preset* has a value; without *common* the defaults of *table* apply. Raises
    ParameterError for a geometry that is not allowed, and if the braid has no effect because all
    of a1 to a6 are given with other values.
    """
    if not (is_given(preset) or is_given(given)):
        return {**preset}
    found = _of_braid({**(common or {}), **preset, **given}, table)
    before = {**preset, **given} if is_given(preset) else given
    both = [name for name in CONSTANTS if name in found and name in before]
    if len(both) == len(CONSTANTS) and all(found[name] != before[name] for name in both):
        raise ParameterError(
            f'{ANGLE} has no effect where a1 to a6 are given: give the braid or the constants'
        )
    return {**preset, **{name: found[name] for name in found if name not in before}}


def is_given(values: Values) -> bool:
    """Return whether *values* contain a parameter of a braid."""
    return any(name in values for name in NAMES)


def without_constants(values: Values, overrides: Values) -> dict[str, Any]:
    """Return *values* of a file without those that the braids in *overrides* determine.

    The parameters of a braid of one muscle have its name before a dot. Such a braid replaces only
    the values of this muscle.
    """
    left_out: set[str] = set()
    for muscle in {
        name.removesuffix(own) for name in overrides for own in NAMES if _is(name, own)
    }:
        in_force = {**values, **overrides}
        if in_force.get(muscle + ANGLE, in_force.get(ANGLE, 0.0)) != 0.0:
            left_out |= {muscle + name for name in FOLLOWING}
    return {name: value for name, value in values.items() if name not in left_out}


def _is(name: str, own: str) -> bool:
    """Return whether *name* is the parameter *own*, the common one or that of one muscle."""
    return name == own or name.endswith(f'.{own}')


def _of_braid(values: Values, table: Table) -> dict[str, Any]:
    """Return the values of the braid among flat *values*, by the names of Muscle's fields.

    The result is empty if the angle is 0. Missing *values* have their defaults in *table*. The
    constants are in the units that *values* name; if they name none, the constants are for Pa and
    a contraction as a fraction.
    """
    read = {
        name: about.check(name, values.get(name, default), kind)
        for name, (kind, default, about) in table.items()
        if name in (*NAMES, *LIMITS)
    }
    if read[ANGLE] == 0.0:
        return {}
    try:
        braid = Braid(**{name.removeprefix(PREFIX): read[name] for name in NAMES})
    except ParameterError as error:
        raise ParameterError(f'{PREFIX}{error}') from error
    found = braid.fields(*(read[name] for name in LIMITS))
    pressure_unit, contraction_unit = (str(values.get(name, found[name])) for name in UNITS)
    a1, a2, a3, a4, a5, a6 = (found[name] for name in CONSTANTS)
    constants = from_si((a1, a2, a3, a4, a5, a6), pressure_unit, contraction_unit)
    units = zip(UNITS, (pressure_unit, contraction_unit), strict=True)
    return {**found, **dict(zip(CONSTANTS, constants, strict=True)), **dict(units)}
