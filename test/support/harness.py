# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Programs of this package as processes of their own, and a node that talks to them over DDS.

Nothing here sleeps for discovery: every wait is for a condition, and DEADLINE only bounds how
long a broken program may hang a test.
"""

import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from time import monotonic
from typing import Any

import rclpy
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.qos import QoSProfile

DEADLINE = 60.0  # s
DEPTH = 20_000  # more messages than any test waits for: none is dropped


class Program:
    """A program ``pam_ros.nodes.<name>`` in a process group of its own.

    As a context it is stopped at the end: by Ctrl-C, or by force where it does not heed that.
    """

    def __init__(self, name: str, *arguments: str, parameters: Mapping[str, Any] | None = None):
        for key, value in (parameters or {}).items():
            arguments += ('-p', f'{key}:={_text(value)}')
        self._out = tempfile.TemporaryFile('w+')  # noqa: SIM115 closed at the end of the context
        self._process = subprocess.Popen(
            [sys.executable, '-m', f'pam_ros.nodes.{name}', '--ros-args', *arguments],
            stdout=self._out,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            env={**os.environ, 'PYTHONUNBUFFERED': '1'},
        )

    def __enter__(self) -> 'Program':
        return self

    def __exit__(self, *_: object) -> None:
        if self.is_running:
            self.interrupt()
            try:
                self._process.wait(DEADLINE)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
                raise
        self._out.close()

    @property
    def is_running(self) -> bool:
        return self._process.poll() is None

    def interrupt(self, kind: int = signal.SIGINT, times: int = 1) -> None:
        """Send a signal to the program's group, as a terminal or launch does."""
        for _ in range(times):
            os.killpg(self._process.pid, kind)

    def wait(self) -> int:
        """Wait for the program's end and return its exit code."""
        return self._process.wait(DEADLINE)

    def has_loaded(self, library: str) -> bool:
        """Say whether it has mapped a shared library of this name by now (Linux)."""
        return library in Path(f'/proc/{self._process.pid}/maps').read_text()

    @property
    def output(self) -> str:
        """What it has printed so far, both streams."""
        self._out.seek(0)
        return self._out.read()


def _text(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


class Peer:
    """A node of the test: collects messages, sends them, calls services."""

    count = 0

    def __init__(self) -> None:
        Peer.count += 1
        self.context = rclpy.Context()
        rclpy.init(context=self.context)
        self.node = rclpy.create_node(f'peer_{Peer.count}', context=self.context)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)
        self._publishers: dict[str, Any] = {}

    def __enter__(self) -> 'Peer':
        return self

    def __exit__(self, *_: object) -> None:
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self.context)

    def until(self, condition: Callable[[], Any], what: str) -> Any:
        """Work until *condition* gives something true, and return that."""
        end = monotonic() + DEADLINE
        while not (result := condition()):
            assert monotonic() < end, f'waited in vain for {what}'
            self._executor.spin_once(timeout_sec=0.05)
        return result

    def collect(self, kind: type, topic: str) -> list[Any]:
        """Subscribe, and return the list that the messages will come into."""
        messages: list[Any] = []
        self.node.create_subscription(kind, topic, messages.append, QoSProfile(depth=DEPTH))
        return messages

    def more(self, messages: list[Any], count: int = 1) -> None:
        """Wait for *count* messages more than there are now."""
        wanted = len(messages) + count
        self.until(lambda: len(messages) >= wanted, f'{count} messages more')

    def publish(self, message: Any, topic: str) -> None:
        """Publish once somebody listens."""
        if topic not in self._publishers:
            self._publishers[topic] = self.node.create_publisher(type(message), topic, 10)
        publisher = self._publishers[topic]
        self.until(publisher.get_subscription_count, f'a subscriber of {topic}')
        publisher.publish(message)

    def call(self, kind: type, service: str, **request: Any) -> Any:
        """Call a service and return its response."""
        client = self.node.create_client(kind, service)
        self.until(client.service_is_ready, f'the service {service}')
        future = client.call_async(kind.Request(**request))
        self.until(future.done, f'the answer of {service}')
        self.node.destroy_client(client)
        return future.result()

    def set_together(self, node: str, **values: Any) -> Any:
        """Set parameters atomically; ``__`` in a name stands for a dot."""
        response = self.call(
            SetParametersAtomically,
            f'{node}/set_parameters_atomically',
            parameters=_messages(values),
        )
        return response.result

    def set_one(self, node: str, **value: Any) -> Any:
        """Set one parameter as ``ros2 param set`` does."""
        response = self.call(SetParameters, f'{node}/set_parameters', parameters=_messages(value))
        return response.results[0]

    def get(self, node: str, *names: str) -> list[Any]:
        """Return the values of parameters."""
        response = self.call(GetParameters, f'{node}/get_parameters', names=list(names))
        return [parameter_value_to_python(value) for value in response.values]

    def describe(self, node: str, *names: str) -> list[Any]:
        """Return the descriptions of parameters."""
        response = self.call(DescribeParameters, f'{node}/describe_parameters', names=list(names))
        return list(response.descriptors)


def _messages(values: Mapping[str, Any]) -> list[ParameterMessage]:
    return [
        Parameter(name.replace('__', '.'), value=value).to_parameter_msg()
        for name, value in values.items()
    ]
