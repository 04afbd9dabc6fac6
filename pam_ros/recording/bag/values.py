# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How one number is read from the messages of a topic, of the joint that it is of."""

import re
from typing import Any

from pam_ros.errors import RecordingError

_STEP = re.compile(r'(?P<name>[A-Za-z_]\w*)(?:\[(?P<index>[^\]]+)\])?')


class FieldReader:
    """Reads the number of a field from one message after another.

    Messages such as JointState name what each of their values is of. The value of a name is read
    wherever it is in a message, and a message without the name is not for this reader. Without a
    name, all messages must be of the same joint.
    """

    def __init__(self, bag: str, topic: str, path: str) -> None:
        """Read the field *path*, such as ``position[elbow]``, of the *topic* of the bag *bag*."""
        self._steps = [(match['name'], match['index']) for match in _STEP.finditer(path)]
        self._where = f'{bag}: {topic}.{path}'
        self._option = f'{topic}.{path.partition("[")[0]}'
        self._seen: dict[str, None] = {}  # names of the values, and of all in the messages
        self._named: dict[str, None] = {}
        self._has_values = False

    def read(self, message: Any) -> float | None:
        """Return the number in a message, NaN if it is not filled, None if it is of others.

        Raises RecordingError for a message without such a number.
        """
        value = message
        for name, index in self._steps:
            if not hasattr(value, name):
                raise RecordingError(f'{self._where} is not there: the message has no {name!r}')
            value = getattr(value, name)
            if index is not None:
                found = self._element(message, value, index)
                if found is None:
                    return None
                value = found
        self._has_values = True
        if isinstance(value, (int, float)):
            return float(value)
        return self._only(message, value)

    def check(self) -> None:
        """Raise RecordingError if the numbers are of several joints, or of none."""
        names = ', '.join(self._named)
        if not self._has_values:
            raise RecordingError(f'{self._where} is not there: the messages name {names}')
        if len(self._seen) > 1:
            raise RecordingError(
                f'{self._where} is of several joints ({", ".join(self._seen)}): say which with '
                f"--column '{self._option}[NAME]=QUANTITY_UNIT'"
            )

    def _element(self, message: Any, value: Any, index: str) -> Any:
        """Return the element of an array, None if the message has no such name."""
        if not hasattr(value, '__len__'):
            raise RecordingError(
                f'{self._where} is not there: the message has one value, without an index'
            )
        names = self._names(message)
        if index in names:
            at = names.index(index)
        elif index.isdecimal():
            at = int(index)
            if at < len(names):
                self._seen[names[at]] = None
        elif names:
            return None
        else:
            raise RecordingError(f'{self._where} is not there: the message has no names')
        if names and len(value) == 0:
            return float('nan')
        if at >= len(value):
            raise RecordingError(
                f'{self._where} is not there: the message has {len(value)} values'
            )
        return value[at]

    def _only(self, message: Any, value: Any) -> float:
        """Return the one number of an array, NaN if it is empty."""
        names = self._names(message)
        try:
            count = len(value)
            if count == 1:
                self._seen.update(dict.fromkeys(names))
                return float(value[0])
        except (TypeError, ValueError) as error:
            raise RecordingError(f'{self._where} is not a number') from error
        if count == 0:
            return float('nan')
        shown = ', '.join(names) or f'0 to {count - 1}'
        raise RecordingError(
            f'{self._where} has {count} values ({shown}): say which with --column '
            f"'{self._option}[NAME]=QUANTITY_UNIT'"
        )

    def _names(self, message: Any) -> list[str]:
        names = list(getattr(message, 'name', ()))
        self._named.update(dict.fromkeys(names))
        return names
