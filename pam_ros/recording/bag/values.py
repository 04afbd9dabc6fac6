# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How one number is read from the messages of a topic."""

import re
from collections.abc import Callable
from typing import Any

from pam_ros.errors import RecordingError


def getter(name: str, topic: str, path: str) -> Callable[[Any], float]:
    """Return the function that reads a number from a message, NaN if it is unfilled.

    The number is the field *path*, such as ``position[elbow]``, of the *topic* of the bag *name*.
    The function raises RecordingError for a message without it.
    """
    steps = [
        (match['name'], match['index'])
        for match in re.finditer(r'(?P<name>[A-Za-z_]\w*)(?:\[(?P<index>[^\]]+)\])?', path)
    ]
    where = f'{name}: {topic}.{path}'

    def get(message: Any) -> float:
        value = message
        for part, index in steps:
            if not hasattr(value, part):
                raise RecordingError(f'{where} is not there: the message has no {part!r}')
            value = getattr(value, part)
            if index is not None:
                value = _element(where, message, value, index)
        if isinstance(value, (int, float)):
            return float(value)
        return _only(where, message, value)

    return get


def _element(where: str, message: Any, value: Any, index: str) -> Any:
    if not hasattr(value, '__len__'):
        raise RecordingError(f'{where} is not there: the message has one value, without an index')
    names = list(getattr(message, 'name', ()))
    if index in names:
        at = names.index(index)
    elif index.isdecimal():
        at = int(index)
    else:
        raise RecordingError(f'{where} is not there: the message names {", ".join(names)}')
    if at >= len(value):
        raise RecordingError(f'{where} is not there: the message has {len(value)} values')
    return value[at]


def _only(where: str, message: Any, value: Any) -> float:
    """Return the one number of an array, NaN if it is empty."""
    try:
        count = len(value)
        if count == 1:
            return float(value[0])
    except (TypeError, ValueError) as error:
        raise RecordingError(f'{where} is not a number') from error
    if count == 0:
        return float('nan')
    names = ', '.join(getattr(message, 'name', ())) or f'0 to {count - 1}'
    raise RecordingError(
        f'{where} has {count} values ({names}): say which with --column '
        f"'{where.split(': ', 1)[1]}[NAME]=QUANTITY_UNIT'"
    )
