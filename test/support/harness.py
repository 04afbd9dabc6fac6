# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A node of the test that talks to programs of this package over DDS.

Nothing here sleeps for discovery: every wait is for a condition, and a client's patience only
bounds how long a broken program may hang a test.
"""

from pathlib import Path
from typing import Any

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.parameter import Parameter, parameter_value_to_python

from pam_ros.nodes.demo.client import Client
from pam_ros.nodes.demo.rig_log import TOPICS
from pam_ros.processes.children import PATIENCE as DEADLINE
from pam_ros.processes.children import Program as FreshProgram
from support.forked import Forked, is_possible

# s; it only bounds how long a broken program may hang a test, also next to busy programs.
PEER_DEADLINE = 240.0
HISTORY = 5000  # messages that a simulator keeps for a late subscriber: 10 s at 500 Hz

__all__ = ['DEADLINE', 'FreshProgram', 'Peer', 'Program', 'has_loaded', 'lose_nothing']


class Program(FreshProgram):
    """A program in a process of its own, which is forked to save the time of its imports.

    Where its start, its signals or its libraries are what is tested, a ``FreshProgram`` is used.
    """

    def _start(self, module: str, arguments: list[str]) -> Any:
        if is_possible():
            return Forked(module, arguments, self._out)
        return super()._start(module, arguments)


class Peer(Client):
    """A client that also looks at a node's parameters as the command line does."""

    def __init__(self, namespace: str = '', patience: float = PEER_DEADLINE) -> None:
        """Make the node; see ``Client``."""
        super().__init__(namespace, patience)

    def set_one(self, node: str, **value: Any) -> Any:
        """Set one parameter as ``ros2 param set`` does."""
        service = f'{node}/set_parameters'
        return self.call(SetParameters, service, parameters=_parameters(**value)).results[0]

    def set_together(self, node: str, **values: Any) -> Any:
        """Set parameters atomically; ``__`` in a name stands for a dot. Return the result."""
        service = f'{node}/set_parameters_atomically'
        return self.call(SetParametersAtomically, service, parameters=_parameters(**values)).result

    def get(self, node: str, *names: str) -> list[Any]:
        """Return the values of parameters."""
        response = self.call(GetParameters, f'{node}/get_parameters', names=list(names))
        return [parameter_value_to_python(value) for value in response.values]

    def describe(self, node: str, *names: str) -> list[Any]:
        """Return the descriptions of parameters."""
        response = self.call(DescribeParameters, f'{node}/describe_parameters', names=list(names))
        return list(response.descriptors)


def lose_nothing(namespace: str = '') -> dict[str, int]:
    """Return the parameters with which a ``pam_sim`` keeps messages until they are received."""
    return {f'qos_overrides.{namespace}/{topic}.publisher.depth': HISTORY for topic in TOPICS}


def has_loaded(program: Program, library: str) -> bool:
    """Say whether a program has mapped a shared library of this name by now (Linux)."""
    return library in Path(f'/proc/{program.process.pid}/maps').read_text()


def _parameters(**values: Any) -> list[ParameterMessage]:
    """Return values as messages; ``__`` in a name stands for a dot."""
    return [
        Parameter(name.replace('__', '.'), value=value).to_parameter_msg()
        for name, value in values.items()
    ]
