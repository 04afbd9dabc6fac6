# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A parameter of an effect: a field of its dataclass, with the data that a fit needs."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ParamSpec

from pam_ros.parameters import Parameter, field_about
from pam_ros.units import powers, revolute_unit

P = ParamSpec('P')
# On a revolute joint the highest value of a length along the motion is the angle that this length
# covers at an arm of 20 mm. Few joints have a shorter one.
SHORT_ARM = 0.02  # m
# Muscles of 45 N and of 20 kN, of 8 kPa and of 5 MPa, are far from the reference rig.
# So a value may be so many times as large, or as small, if its unit contains these.
WIDER = {'N': 100.0, 'Pa': 100.0, 'kg': 100.0, 'm': 10.0}


@dataclass(frozen=True, kw_only=True)
class EffectParameter(Parameter):
    """Description of a parameter of an effect, in SI.

    ``low`` and ``high`` are the allowed values on any rig, ``fit_low`` and ``fit_high`` those that
    a fit may reach on the reference rig (:mod:`pam_ros.sizes`). ``strength``
    marks a parameter whose 0 means that the effect is absent. ``scale`` is a typical size (fits
    are scaled by it), and ``sign`` the physical sign that a fitted strength must have (0: either).
    ``needs_fine_steps`` marks one that long steps of a simulation hide; a fit begins with its
    typical size. ``name`` and ``default`` are those of its field.
    """

    name: str = ''
    default: float = 0.0
    low: float
    high: float
    fit_low: float
    fit_high: float
    scale: float
    strength: bool = False
    sign: int = 0
    needs_fine_steps: bool = False

    def sized(self, factor: float, scale: float) -> 'EffectParameter':
        """Return it for a rig on which its unit is *factor* times as large.

        *scale* is the factor of its typical size, which depends on the kind of joint as well.
        """
        return replace(
            self,
            low=factor * self.fit_low,
            high=factor * self.fit_high,
            scale=scale * self.scale,
            default=factor * self.default,
        )

    def for_revolute(self, name: str) -> 'EffectParameter':
        """Return its description for a revolute joint, where a contraction becomes an angle.

        *name* is for the ParameterError that is raised if its unit has no counterpart there.
        """
        unit = revolute_unit(self.unit, name)
        if self.unit == 'fraction':
            low, high = -math.pi, math.pi
            return replace(self, unit=unit, low=low, high=high, fit_low=low, fit_high=high)
        if self.unit == 'm':
            high, fit_high = self.high / SHORT_ARM, self.fit_high / SHORT_ARM
            return replace(self, unit=unit, high=high, fit_high=fit_high)
        return replace(self, unit=unit)

    def on_any_joint(self) -> 'EffectParameter':
        """Return it with a range that contains those of both kinds of joint."""
        if self.unit not in ('fraction', 'm'):
            return self
        turned = self.for_revolute(self.name)
        low, high = min(self.low, turned.low), max(self.high, turned.high)
        return replace(self, unit=f'{self.unit} or rad', low=low, high=high)


def effect_parameter(
    default: float,
    text: str,
    unit: str = '',
    *,
    low: float,
    high: float,
    scale: float,
    needs_fine_steps: bool = False,
) -> float:
    """Return a field of an effect's dataclass, with its *default* and its description.

    *low* and *high* are those of a fit on the reference rig.
    """
    about = _about(text, unit, low, high, scale)
    return _float_field(default, replace(about, needs_fine_steps=needs_fine_steps))


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

    *low* and *high* are those of a fit on the reference rig. The default of *sign* is 1 for a
    range that begins at 0, and 0 for all other ranges.
    """
    known = int(low == 0.0) if sign is None else sign
    about = _about(text, unit, low, high, scale)
    return _float_field(0.0, replace(about, strength=True, sign=known))


def _about(text: str, unit: str, low: float, high: float, scale: float) -> EffectParameter:
    """Return the description of a parameter that has this range on the reference rig."""
    wider = max([1.0, *(WIDER.get(symbol, 1.0) for symbol in powers(unit))])
    return EffectParameter(
        text=text,
        unit=unit,
        low=low / wider if low > 0.0 else low * wider,
        high=high * wider,
        fit_low=low,
        fit_high=high,
        scale=scale,
    )


def _float_field(default: float, about: EffectParameter) -> float:
    made: float = field_about(default, about)
    return made


def start_from(
    effect: Callable[P, object], *positional: P.args, **values: P.kwargs
) -> dict[str, float]:
    """Return the *values* of parameters of an *effect* from which a fit begins.

    The constructor of the effect checks them. The fit may change the named parameters.
    """
    effect(*positional, **values)
    named: dict[str, Any] = values
    return named
