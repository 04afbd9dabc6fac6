# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The lines that use ``identified.yaml``: a simulation, a controller, and a Python program."""

import shlex
from dataclasses import dataclass
from pathlib import Path

from pam_ros.errors import printable


@dataclass(frozen=True)
class Use:
    """A line to copy, and what it does."""

    what: str
    line: str


def uses_of(file: Path) -> list[Use]:
    """Return the lines that use the parameter *file*; its path becomes absolute.

    Programs are started as in a ROS 2 workspace.
    """
    path = printable(str(file.absolute()))
    given = f'--ros-args --params-file {shlex.quote(path)}'
    return [
        Use('Simulate the identified rig', f'ros2 run pam_ros pam_sim {given}'),
        Use('Control it with the identified model', f'ros2 run pam_ros pam_control {given}'),
        Use('Load it in Python', f'from pam_ros import load_joint; joint = load_joint({path!r})'),
    ]
