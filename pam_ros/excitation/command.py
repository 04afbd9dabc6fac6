# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The command line of ``pam_excite`` that plays an experiment."""

from collections.abc import Mapping
from typing import Any


def command_line(parameters: Mapping[str, Any], file: str = '') -> str:
    """Return the command of a shell that plays a programme with these *parameters*.

    *file* is a parameter file of the rig; '' is none.
    """
    words = [f' --params-file {file}'] if file else []
    words += [f' -p {name}:={_written(value)}' for name, value in parameters.items()]
    return 'pam_excite' + (' --ros-args' + ''.join(words) if words else '')


def _written(value: Any) -> str:
    return f"'[{', '.join(value)}]'" if isinstance(value, tuple) else f'{value:g}'
