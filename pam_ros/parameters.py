# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Declarative parameters: a dataclass field that carries unit, range and text.

One table per room feeds everything: checks here, ROS parameters in ``nodes/``, the
documentation, and the YAML files.
"""

import math
from dataclasses import Field, dataclass, field, fields
from typing import Any

from pam_ros.errors import ParameterError

_KEY = 'parameter'


@dataclass(frozen=True)
class Parameter:
    """What is known of one parameter beside its value.

    ``low`` and ``high`` are inclusive and in ``unit``; ``None`` means unbounded.
    ``choices`` lists the allowed values of a string. ``live`` says whether a running node
    may change it. ``above_low`` makes the lower bound exclusive.
    """

    text: str
    unit: str = ''
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    live: bool = True
    above_low: bool = False

    def allowed(self) -> str:
        """Say in words what is allowed, for the sentence of an error."""
        if self.choices:
            return 'one of ' + ', '.join(self.choices)
        unit = f' {self.unit}' if self.unit else ''
        left = 'above' if self.above_low else 'at least'
        if self.low is not None and self.high is not None:
            if self.above_low:
                return f'above {self.low:g} and at most {self.high:g}{unit}'
            return f'{self.low:g} to {self.high:g}{unit}'
        if self.low is not None:
            return f'{left} {self.low:g}{unit}'
        if self.high is not None:
            return f'at most {self.high:g}{unit}'
        return 'a finite number'

    def check(self, name: str, value: Any, kind: type) -> Any:
        """Return *value* as *kind*, or raise ParameterError naming it and what is allowed."""
        problem = ParameterError(f'{name} = {value!r} is not allowed: give {self.allowed()}')
        if kind is str:
            if not isinstance(value, str) or (self.choices and value not in self.choices):
                raise problem
            return value
        if kind is bool:
            if not isinstance(value, bool):
                raise ParameterError(f'{name} = {value!r} is not allowed: give true or false')
            return value
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise problem
        if kind is int and float(value) != int(value):
            raise ParameterError(f'{name} = {value!r} is not allowed: give a whole number')
        number = float(value)
        if not math.isfinite(number):
            raise problem
        low_bad = self.low is not None and (
            number < self.low or (self.above_low and number == self.low)
        )
        if low_bad or (self.high is not None and number > self.high):
            raise problem
        return kind(value)


def parameter(default: Any, text: str, unit: str = '', **kwargs: Any) -> Any:
    """Return a dataclass field with *default* that carries a :class:`Parameter`."""
    return field(default=default, metadata={_KEY: Parameter(text, unit, **kwargs)})


def described(cls: type) -> dict[str, tuple[type, Any, Parameter]]:
    """Return name -> (type, default, Parameter) of the described fields of a dataclass."""
    table = {}
    for item in fields(cls):
        if _KEY in item.metadata:
            table[item.name] = (type(item.default), item.default, item.metadata[_KEY])
    return table


def check_all(instance: Any) -> None:
    """Check and normalise every described field of a (frozen) dataclass instance."""
    item: Field[Any]
    for item in fields(instance):
        if _KEY in item.metadata:
            value = item.metadata[_KEY].check(
                item.name, getattr(instance, item.name), type(item.default)
            )
            object.__setattr__(instance, item.name, value)
