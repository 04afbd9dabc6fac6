# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters ``braid.*``: a self-made McKibben muscle declared by its geometry.

They act as a preset does: they give a1..a6, their units, the rated force and the source. What is
given as a parameter beside them comes before.
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
    """Return the table of the braid, without one by default."""
    kind, _, about = described(Braid)['angle']
    text = f'{about.text}; 0: a1 to a6 are given, not the geometry'
    return {**table_of(Braid, PREFIX), ANGLE: (kind, 0.0, replace(about, text=text, low=0.0))}


BRAID = _table()


def with_braid(
    preset: Values, given: Values, table: Table, common: Values | None = None
) -> dict[str, Any]:
    """Return *preset* with what follows from a braid that it or *given* describes.

    *given* are flat parameters, which come before what follows from the braid, and so do those of
    a preset that describes the braid itself. *common* are the values in force where neither says
    anything; without it they are the defaults of *table*. Raises ParameterError for a geometry
    that is not allowed, and where it has no effect.
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
    """Say whether *values* have a parameter of a braid."""
    return any(name in values for name in NAMES)


def without_constants(values: Values, overrides: Values) -> dict[str, Any]:
    """Return *values* of a file without what follows from the braids that *overrides* describe.

    A braid of one muscle, with its name before a dot, replaces the constants of this muscle alone.
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
    """Say whether *name* is the parameter *own*, the common one or that of one muscle."""
    return name == own or name.endswith(f'.{own}')


def _of_braid(values: Values, table: Table) -> dict[str, Any]:
    """Return what follows from the braid among flat *values*, by the names of Muscle's fields.

    Nothing where its angle is 0. What is not among *values* has its default in *table*. Constants
    are in the units that *values* name; without them for Pa and contraction as a fraction.
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
