# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The start of a node's program: signal handlers first, then slow imports.

Therefore Ctrl-C and the other signals end a program cleanly from its first tenth of a second on.
"""

import gc
import sys
from importlib import import_module
from itertools import takewhile
from pathlib import Path
from typing import NoReturn

from pam_ros.cli.help_text import help_text
from pam_ros.processes.ends import ignore_ends
from pam_ros.processes.outputs import guard_outputs
from pam_ros.processes.stop import StopRequest
from pam_ros.version import VERSION_LINE

NEEDS_ROS = (
    'rclpy, the Python library of ROS 2, is not installed for this Python: if ROS 2 is installed, '
    'source its setup file first, such as /opt/ros/jazzy/setup.bash'
)


def start_node(module: str, name: str, about: str | None) -> NoReturn:
    """Run the node class *name* of *module* until a stop is requested; exit with its code.

    *about* is the docstring that ``--help`` shows. ``--version`` does not start ROS.
    """
    stop = StopRequest()
    guard_outputs()
    if '--version' in _before_ros(sys.argv[1:]):
        print(VERSION_LINE)
        sys.exit(0)
    # Imported objects stay: garbage collection of them would take a fifth of the start time.
    gc.disable()
    try:
        spin = import_module('pam_ros.nodes.common.spin')
        node = getattr(import_module(module), name)
    except ModuleNotFoundError as error:
        if error.name != 'rclpy':
            raise
        print(f'{Path(sys.argv[0]).stem}: {NEEDS_ROS}', file=sys.stderr)
        sys.exit(1)
    try:
        code = spin.run(node, stop, help_text(about))
    finally:
        ignore_ends()
    sys.exit(code)


def _before_ros(arguments: list[str]) -> list[str]:
    """Return the arguments of a program that precede those for ROS."""
    return list(takewhile(lambda word: word != '--ros-args', arguments))
