# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tuning numbers of the control laws: each with its unit and its source.

They are fields of frozen dataclasses, one for each part, and those of the reference rig of
:mod:`pam_ros.sizes`. Lengths and forces are those along the line of a muscle, so that they are
valid for every joint. A law has them in the sizes and in the units of its joint
(:class:`JointScale`), which follow from the unit of each number alone.

Names of sources: *noise* is the noise of 20 um of the position in the benchmarks; *control*,
*pair_control* and *disturbance* are benchmarks (``make bench ARGS=control``), mostly followed by
the row of their tables that decided.
"""

from dataclasses import dataclass, field, fields, replace
from typing import Any, TypeVar

from pam_ros.control.model import ControlModel
from pam_ros.sizes import REFERENCE, Sizes, tuned_sizes_of
from pam_ros.units import powers, revolute_unit

T = TypeVar('T')
SYMBOLS = {'m', 's', 'rad', 'N', 'Pa'}  # in the units of tuning numbers


@dataclass(frozen=True)
class Number:
    """Unit and source of a tuning number.

    With *along_muscle* it is that along the line of a muscle. Otherwise it is of the coordinate,
    and has the same value on a prismatic and on a revolute joint.
    """

    unit: str
    source: str
    along_muscle: bool = True


def number(value: Any, unit: str, source: str, *, along_muscle: bool = True) -> Any:
    """Return a dataclass field with this value; *source* states its meaning and its origin."""
    return field(default=value, metadata={'number': Number(unit, source, along_muscle)})


def numbers_of(cls: type) -> dict[str, tuple[Any, Number]]:
    """Return name -> (value, Number) of a dataclass of tuning numbers."""
    return {item.name: (item.default, item.metadata['number']) for item in fields(cls)}


@dataclass(frozen=True)
class JointScale:
    """How the tuning numbers of a joint follow from those of one muscle of the reference rig.

    ``sizes`` are those of the rig, ``length`` is the coordinate per metre of muscle, and ``force``
    the effort if each muscle pulls with 1 N.
    """

    sizes: Sizes = REFERENCE
    length: float = 1.0
    force: float = 1.0
    is_revolute: bool = False

    def factor(self, about: Number) -> float:
        """Return the factor of a number; raises KeyError for a unit that is not known."""
        power = powers(about.unit)
        if unknown := set(power) - SYMBOLS:
            raise KeyError(f'{about.unit}: {unknown} is not a unit of tuning numbers')
        if about.along_muscle:
            turned = self.length ** power.get('m', 0) * self.force ** power.get('N', 0)
            return self.sizes.factor(about.unit) * turned
        return self.sizes.factor(
            revolute_unit(about.unit, about.source) if self.is_revolute else about.unit
        )

    def of(self, tuning: T) -> T:
        """Return *tuning* in the sizes and in the units of the joint."""
        changes = {}
        for name, (_, about) in numbers_of(type(tuning)).items():
            if set(powers(about.unit)) <= {'s', 'rad'}:
                continue  # the same on every joint, and it may be a count
            value, factor = getattr(tuning, name), self.factor(about)
            is_many = isinstance(value, tuple)
            changes[name] = tuple(factor * v for v in value) if is_many else factor * value
        return replace(tuning, **changes)  # type: ignore[type-var]


def scale_of(model: ControlModel) -> JointScale:
    """Return the scale of the tuning numbers of a joint."""
    joint = model.joint
    return JointScale(tuned_sizes_of(joint), 1.0 / model.arm, model.arms, joint.is_revolute)
