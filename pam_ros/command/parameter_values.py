# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Values of parameters from texts, of the type and unit that a node declares."""

import re
from typing import Any

from pam_ros.command.amounts import amount_of
from pam_ros.errors import PamError
from pam_ros.settings.tables import listed
from pam_ros.similar_names import similar

UNIT = re.compile(r'\[([^\[\]]+)\]$')  # at the end of a description, as nodes of pam_ros have it


def value_of(name: str, text: str, kind: type, description: str, *, is_list: bool = False) -> Any:
    """Return the value of the parameter *name* that *text* gives, as *kind*.

    *kind* is bool, int, float or str; with *is_list* it is that of the items. A number may have a
    unit that converts to the one at the end of the *description*. Raises PamError for a text that
    does not give such a value.
    """
    if is_list:
        return [value_of(name, item, kind, description) for item in listed(text)]
    if kind is bool:
        if text.lower() not in ('true', 'false'):
            raise PamError(f'{name} = {text!r} is not allowed: give true or false')
        return text.lower() == 'true'
    if kind is str:
        return text
    unit = UNIT.search(description)
    number = amount_of(text, (unit[1],) if unit else (), name).value
    if kind is int:
        if not number.is_integer():
            raise PamError(f'{name} = {text!r} is not allowed: give a whole number')
        return int(number)
    return number


def refuse_unknown(name: str, known: list[str], nodes: str) -> PamError:
    """Return the error for a parameter *name* that is not one of the *known* of the *nodes*."""
    alike = similar(name, known)
    hint = f'was {alike} meant?' if alike else 'pam_command list prints all'
    return PamError(f'{name} is not a parameter of {nodes}: {hint}')
