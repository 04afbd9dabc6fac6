# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The health of one part of a program."""

from collections.abc import Mapping
from enum import Enum
from typing import Any, NamedTuple


class Level(Enum):
    """The level of health, from good to bad."""

    OK = 'ok'
    WARN = 'warn'
    ERROR = 'error'


class Health(NamedTuple):
    """The health of one part of a program: a level, a sentence, and numbers with their units."""

    level: Level
    message: str
    values: Mapping[str, Any]
