# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The flat names of the parameters of effects in ROS, YAML and reports, and their parsing.

``effects.creep.stiffness`` is the parameter stiffness of the effect creep.
"""

from collections.abc import Mapping
from typing import NamedTuple, TypeVar

GROUP = 'effects'
T = TypeVar('T')


class EffectName(NamedTuple):
    """A parameter of an effect."""

    effect: str
    parameter: str

    @property
    def flat(self) -> str:
        """The flat name."""
        return f'{GROUP}.{self.effect}.{self.parameter}'


def parsed(flat: str) -> EffectName | None:
    """Return the effect and the parameter of a flat name, None if it is not one of an effect."""
    group, _, rest = flat.partition('.')
    effect, _, parameter = rest.partition('.')
    return EffectName(effect, parameter) if group == GROUP and parameter else None


def by_effect(values: Mapping[str, T]) -> dict[str, dict[str, T]]:
    """Return the values of effects in the flat *values*, as effect -> parameter -> value."""
    found: dict[str, dict[str, T]] = {}
    for flat, value in values.items():
        name = parsed(flat)
        if name is not None:
            found.setdefault(name.effect, {})[name.parameter] = value
    return found
