# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A parameter of an effect: a field of its dataclass, with what a fit needs to know of it."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ParamSpec

from pam_ros.parameters import Parameter, field_about
from pam_ros.units import turned_unit

P = ParamSpec('P')


@dataclass(frozen=True, kw_only=True)
class EffectParameter(Parameter):
    """What is known of a parameter of an effect, in SI.

    ``strength`` marks a parameter whose 0 means that the effect is absent. ``scale`` is a typical
    size (fits are scaled by it), and ``sign`` the physical sign that a fitted strength must have
    (0: either). ``name`` and ``default`` are those of its field.
    """

    name: str = ''
    default: float = 0.0
    low: float
    high: float
    scale: float
    strength: bool = False
    sign: int = 0

    def turned(self, name: str) -> 'EffectParameter':
        """Return what is known of it on a joint that turns, where a contraction is an angle.

        *name* is the one in an error: ParameterError where its unit has no meaning there.
        """
        unit = turned_unit(self.unit, name)
        if self.unit == 'fraction':
            return replace(self, unit=unit, low=-math.pi, high=math.pi)
        return replace(self, unit=unit)

    def on_any_joint(self) -> 'EffectParameter':
        """Return it with the range that it has on one kind of joint or the other."""
        if self.unit != 'fraction':
            return self
        low, high = min(self.low, -math.pi), max(self.high, math.pi)
        return replace(self, unit='fraction or rad', low=low, high=high)


def effect_parameter(
    default: float, text: str, unit: str = '', *, low: float, high: float, scale: float
) -> float:
    """Return a field of an effect's dataclass, with its *default* and what is known of it."""
    about = EffectParameter(text=text, unit=unit, low=low, high=high, scale=scale)
    return _float_field(default, about)


def strength(
    text: str,
    unit: str = '',
    *,
    low: float = 0.0,
    high: float,
    scale: float,
    sign: int | None = None,
) -> float:
    """Return a field whose default, 0, means that the effect is absent.

    Of a range that begins at 0 the *sign* is 1, unless another one is given; of all others 0.
    """
    known = int(low == 0.0) if sign is None else sign
    about = EffectParameter(
        text=text, unit=unit, low=low, high=high, scale=scale, strength=True, sign=known
    )
    return _float_field(0.0, about)


def _float_field(default: float, about: EffectParameter) -> float:
    made: float = field_about(default, about)
    return made


def start_from(
    effect: Callable[P, object], *positional: P.args, **values: P.kwargs
) -> dict[str, float]:
    """Return the *values* of parameters of an *effect* from which a fit begins.

    They are checked as those of the effect are; the fit may change those that are named.
    """
    effect(*positional, **values)
    named: dict[str, Any] = values
    return named
