# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Constructors of dataclasses that refuse an unknown name with the names that they know."""

from abc import ABCMeta
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any

from pam_ros.errors import ParameterError
from pam_ros.similar_names import near


class RefusesUnknownNames(ABCMeta):
    """Metaclass of dataclasses: an unknown or surplus argument raises ParameterError.

    Python raises TypeError, whose text does not contain the names that are allowed.
    """

    if not TYPE_CHECKING:  # type checkers read the generated constructor

        def __call__(cls, *values: Any, **named: Any) -> Any:
            """Create an object from its fields."""
            if is_dataclass(cls):
                _check(cls, len(values), named)
            return super().__call__(*values, **named)


def _check(cls: type, count: int, named: dict[str, Any]) -> None:
    """Raise ParameterError if *cls* has no such fields, or fewer than *count* without a name."""
    known = sorted(
        (field for field in fields(cls) if field.init), key=lambda field: bool(field.kw_only)
    )
    names = [field.name for field in known]
    for name in named:
        if name not in names:
            found = near(name, names)
            meant = f'was {" or ".join(found)} meant?' if found else f'give {", ".join(names)}'
            raise ParameterError(f'{cls.__name__} has no {name}: {meant}')
    most = sum(not field.kw_only for field in known)
    if count > most:
        raise ParameterError(
            f'{cls.__name__} takes at most {most} values without a name, not {count}: '
            f'give {", ".join(names)}'
        )
