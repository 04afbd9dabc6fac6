# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Check the inputs of users of the Python interface: numbers, arrays and objects.

Each function returns its input in the form that the package works with, or raises ParameterError
with the name, the value or the shape, and the allowed values. Public functions and constructors
use these checks; the functions that they call trust their inputs.
"""

import math
import numbers
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import ParameterError

Array = NDArray[np.float64]
LONGEST_VALUE = 60  # characters of a value that an error message shows


def refuse(name: str, value: Any, allowed: str) -> NoReturn:
    """Raise ParameterError: the *value* of *name* is not one of the *allowed* ones."""
    text = ' '.join(repr(value).split())
    shown = text if len(text) <= LONGEST_VALUE else f'{text[: LONGEST_VALUE - 3]}...'
    raise ParameterError(f'{name} = {shown} is not allowed: give {allowed}')


# Objects -----------------------------------------------------------------------------------------


def instance(name: str, value: Any, kind: type[Any], allowed: str) -> Any:
    """Return *value*, which must be of this *kind*; *allowed* is its description."""
    if not isinstance(value, kind):
        refuse(name, value, allowed)
    return value


def sequence(name: str, values: Any, kind: type[Any], allowed: str) -> tuple[Any, ...]:
    """Return *values* as a tuple: a sequence whose items must be of this *kind*."""
    if isinstance(values, str | Mapping) or not isinstance(values, Iterable):
        refuse(name, values, f'a sequence, each item {allowed}')
    return tuple(instance(f'{name}[{i}]', value, kind, allowed) for i, value in enumerate(values))


def as_path(name: str, value: Any, allowed: str) -> Path:
    """Return *value*, a text or a Path, as a Path; *allowed* describes the target."""
    if not isinstance(value, str | Path):
        refuse(name, value, allowed)
    return Path(value)


# Numbers -----------------------------------------------------------------------------------------


def number(name: str, value: Any) -> float:
    """Return *value* as a finite float."""
    if not _is_finite(value):
        refuse(name, value, 'a finite number')
    return float(value)


def _is_finite(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, numbers.Real):  # numpy's are Real
        return False
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def array(name: str, value: Any) -> Array:
    """Return *value* as a contiguous array of finite numbers, of any shape."""
    try:
        given = np.asarray(value)
    except ValueError:
        refuse(name, value, 'rows of one length')
    if given.dtype.kind not in 'fiu':
        refuse(name, value, 'numbers')
    if np.ma.is_masked(value):
        masked = np.argwhere(np.ma.getmaskarray(value))
        place = ', '.join(str(i) for i in masked[0])
        raise ParameterError(f'{name}[{place}] is masked: give a number, or leave it out')
    found = np.asarray(given, dtype=np.float64, order='C')
    is_finite = np.isfinite(found)
    if not is_finite.all():
        where = np.unravel_index(int(np.argmin(is_finite)), found.shape)
        place = f'[{", ".join(str(i) for i in where)}]' if where else ''
        raise ParameterError(f'{name}{place} = {found[where]} is not allowed: give finite numbers')
    return found


def stamps(name: str, value: Any, *, strict: bool = False) -> Array:
    """Return *value* as stamps in s (n,), at least one, ascending.

    With *strict* no two of them may be equal.
    """
    found = array(name, value)
    if found.ndim != 1 or not found.size:
        refuse_shape(name, found, '(n,), at least one stamp in s')
    steps = np.diff(found)
    is_back = steps <= 0.0 if strict else steps < 0.0
    if is_back.any():
        i = int(np.argmax(is_back))
        order = 'ascending stamps, no two of them equal' if strict else 'ascending stamps'
        raise ParameterError(
            f'{name}[{i + 1}] = {found[i + 1]} s follows {found[i]} s: give {order}'
        )
    return found


def along(name: str, value: Any, clock: str, count: int) -> Array:
    """Return *value* as an array (count,): one number for each stamp of the series *clock*."""
    found = array(name, value)
    if found.shape != (count,):
        refuse_shape(name, found, f'{(count,)}, one number for each stamp of {clock}')
    return found


def one_each(name: str, value: Any, count: int, what: str) -> Array:
    """Return *value* as an array (count,): one number for each *what*, or one for all."""
    found = array(name, value)
    if found.shape == (count,):
        return found
    if found.ndim:
        refuse_shape(name, found, f'{(count,)}, one number for each {what}, or one for all')
    return np.full(count, found)


def alike(**values: Any) -> list[Array]:
    """Return *values* as arrays whose shapes can be broadcast together."""
    found = {name: array(name, value) for name, value in values.items()}
    try:
        np.broadcast_shapes(*(one.shape for one in found.values()))
    except ValueError:
        shapes = ' and '.join(f'{name} {one.shape}' for name, one in found.items())
        raise ParameterError(
            f'the shapes of {shapes} do not fit together: give one shape, or single numbers'
        ) from None
    return list(found.values())


def refuse_shape(name: str, given: Array, allowed: str) -> NoReturn:
    """Raise ParameterError: the shape of *name* is not one of the *allowed* ones."""
    raise ParameterError(f'{name} has the shape {given.shape}: give {allowed}')
