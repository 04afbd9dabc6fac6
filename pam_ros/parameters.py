# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Declarative parameters: a dataclass field that carries unit, range and text.

One table per package is the source for the checks here, the ROS parameters in ``nodes/``, the
documentation, and the YAML files.
"""

import math
import numbers
from dataclasses import MISSING, dataclass, field, fields, replace
from typing import Any, NamedTuple

from pam_ros.arguments import refuse
from pam_ros.units import revolute_unit

_KEY = 'parameter'


class OnRevolute(NamedTuple):
    """Default and highest value of a parameter for a revolute joint."""

    default: Any
    high: float | None


@dataclass(frozen=True)
class Parameter:
    """Description of one parameter, without its value.

    ``low`` and ``high`` are inclusive and in ``unit``; ``None`` means unbounded.
    ``choices`` lists the allowed values of a string, or of each string in a list. ``live`` is true
    if the parameter can be changed while a node runs. ``above_low`` makes the lower bound
    exclusive. ``revolute`` gives the default and the highest value for a revolute joint, if they
    are different numbers.
    """

    text: str
    unit: str = ''
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    live: bool = True
    above_low: bool = False
    revolute: OnRevolute | None = None

    def for_revolute(self, name: str) -> 'Parameter':
        """Return the description of the parameter *name* for a revolute joint."""
        high = self.high if self.revolute is None else self.revolute.high
        return replace(self, unit=revolute_unit(self.unit, name), high=high, revolute=None)

    def allowed(self, kind: type = float, *, is_number: bool = True) -> str:
        """Return a text about the allowed values of type *kind*, for an error message.

        For a value that is no number, *is_number* is false, and the text says that one is needed.
        """
        if self.choices:
            return ('a list of ' if kind is tuple else 'one of ') + ', '.join(self.choices)
        if kind in (bool, str, tuple):
            return {bool: 'true or false', str: 'a text', tuple: 'a list of texts'}[kind]
        whole = 'a whole number' if kind is int else '' if is_number else 'a number'
        unit = f' {self.unit}' if self.unit else ''
        if self.low is None and self.high is None:
            return whole if kind is int else 'a finite number'
        if self.high is None:
            bounds = f'{"above" if self.above_low else "at least"} {self.low:g}{unit}'
        elif self.low is None:
            bounds = f'at most {self.high:g}{unit}'
        elif self.above_low:
            bounds = f'above {self.low:g} and at most {self.high:g}{unit}'
        else:
            bounds = f'{self.low:g} to {self.high:g}{unit}'
        return f'{whole}, {bounds}' if whole else bounds

    def check(self, name: str, value: Any, kind: type) -> Any:
        """Return *value* as *kind*, or raise ParameterError with the name and allowed values."""
        if not self._fits(value, kind):
            refuse(name, value, self.allowed(kind, is_number=_is_number(value)))
        return kind(value)

    def _is_text(self, value: Any, kind: type) -> bool:
        if kind is tuple:
            return isinstance(value, list | tuple) and all(self._is_text(v, str) for v in value)
        return isinstance(value, str) and (not self.choices or value in self.choices)

    def _fits(self, value: Any, kind: type) -> bool:
        if kind in (str, tuple):
            return self._is_text(value, kind)
        if kind is bool:
            return isinstance(value, bool)
        if not _is_number(value):
            return False
        try:
            number = float(value)
        except OverflowError:
            return False
        if not math.isfinite(number) or (kind is int and not number.is_integer()):
            return False
        low, high = self.low, self.high
        low_fits = low is None or number > low or (number == low and not self.above_low)
        return low_fits and (high is None or number <= high)


def _is_number(value: Any) -> bool:
    """Return whether *value* is a real number, of numpy, too; true and false are none."""
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def parameter_field(default: Any, text: str, unit: str = '', **kwargs: Any) -> Any:
    """Return a dataclass field that describes a parameter: of a load, a transmission, a muscle.

    *default* is its value, whose type is that of the parameter; *text* says what it is, and *unit*
    is the unit of the value. Other arguments are those of :class:`Parameter`: the bounds ``low``
    and ``high``, ``above_low`` if the lower bound itself is not allowed, ``choices`` of a text,
    and ``live`` if it can change while a node runs. From it follow the check of the value, the ROS
    parameter with its range, the parameter files and the documentation.
    """
    return field_about(default, Parameter(text, unit, **kwargs))


def field_about(default: Any, about: Parameter, *, kw_only: bool = False) -> Any:
    """Return a dataclass field with *default* that carries its description *about*.

    The default MISSING of dataclasses makes a field that must be given.
    """
    return field(default=default, metadata={_KEY: about}, kw_only=kw_only)


def described(cls: type, *, revolute: bool = False) -> dict[str, tuple[type, Any, Parameter]]:
    """Return name -> (type, default, Parameter) of the described fields of a dataclass.

    With *revolute* they are those of a revolute joint. A field that must be given has the default
    MISSING of dataclasses, and the type that is annotated.
    """
    table = {}
    for item in fields(cls):
        if _KEY in item.metadata:
            about, default = item.metadata[_KEY], item.default
            if revolute:
                default = default if about.revolute is None else about.revolute.default
                about = about.for_revolute(item.name)
            kind: Any = item.type if item.default is MISSING else type(item.default)
            table[item.name] = (kind, default, about)
    return table


def check_all(instance: Any, *, revolute: bool = False) -> None:
    """Check and normalise every described field of a (frozen) dataclass instance.

    With *revolute* the instance is for a revolute joint.
    """
    for name, (kind, _, about) in described(type(instance), revolute=revolute).items():
        object.__setattr__(instance, name, about.check(name, getattr(instance, name), kind))
