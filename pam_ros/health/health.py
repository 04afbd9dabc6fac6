# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How one part of a program is."""

from collections.abc import Mapping
from enum import Enum
from typing import Any, NamedTuple


class Level(Enum):
    """How well a part is, from good to bad."""

    OK = 'ok'
    WARN = 'warn'
    ERROR = 'error'


class Health(NamedTuple):
    """How one part of a program is, in a sentence and in numbers, each with its unit."""

    level: Level
    message: str
    values: Mapping[str, Any]
