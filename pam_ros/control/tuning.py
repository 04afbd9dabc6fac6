# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tuning numbers of the control laws: each with its unit and its source.

They are fields of frozen dataclasses, one for each part. Lengths and forces are those along the
line of a muscle, so that they are valid for every joint: for a joint, a length is divided by the
mean arm of its muscles, and a force is multiplied by the sum of their arms (:func:`scaled`).

Names of sources: *noise* is the noise of 20 um of the position in the benchmarks; *control*,
*pair_control* and *disturbance* are benchmarks (``make bench ARGS=control``), mostly followed by
the row of their tables that decided.
"""

from dataclasses import dataclass, field, fields, replace
from typing import Any, TypeVar

T = TypeVar('T')

# Powers of the scale of lengths and of the scale of forces in each unit.
_POWERS = {
    '': (0, 0),
    's': (0, 0),
    '1/s': (0, 0),
    'rad/s': (0, 0),
    'm': (1, 0),
    'm/s': (1, 0),
    'm/s^2': (1, 0),
    'N': (0, 1),
    'N/s': (0, 1),
    'N^2': (0, 2),
}


@dataclass(frozen=True)
class Number:
    """Unit and source of a tuning number."""

    unit: str
    source: str


def number(value: Any, unit: str, source: str) -> Any:
    """Return a dataclass field with this value; *source* states its meaning and its origin."""
    return field(default=value, metadata={'number': Number(unit, source)})


def numbers_of(cls: type) -> dict[str, tuple[Any, Number]]:
    """Return name -> (value, Number) of a dataclass of tuning numbers."""
    return {item.name: (item.default, item.metadata['number']) for item in fields(cls)}


def scaled(tuning: T, length: float, force: float) -> T:
    """Return *tuning* with lengths and forces in the joint's own units.

    *length* is the coordinate per metre of muscle, *force* the effort if each muscle pulls 1 N.
    """
    changes = {}
    for name, (_, about) in numbers_of(type(tuning)).items():
        lengths, forces = _POWERS[about.unit]
        if lengths or forces:  # else it may be a count, and stays a whole number
            value, scale = getattr(tuning, name), length**lengths * force**forces
            is_many = isinstance(value, tuple)
            changes[name] = tuple(scale * v for v in value) if is_many else scale * value
    return replace(tuning, **changes)  # type: ignore[type-var]
