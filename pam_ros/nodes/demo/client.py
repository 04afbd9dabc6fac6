# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A node that uses other nodes step by step: awaits messages, calls services, sets values."""

import itertools
import os
from collections.abc import Callable
from time import monotonic
from types import TracebackType
from typing import Any, TypeVar

import rclpy
from rclpy.duration import Duration
from rclpy.qos import QoSProfile
from std_srvs.srv import Trigger

from pam_ros.errors import PamError
from pam_ros.nodes.common.rclpy_internals import EventsExecutor
from pam_ros.processes.interrupts import held_back

DEPTH = 20_000  # messages that may wait: none is dropped
AGAIN = 10.0  # s without an answer after which a service is called again
TURN = 0.05  # s after which a condition is checked again if no message arrives
_numbers = itertools.count()
T = TypeVar('T')


class Client:
    """A node in its own context that handles messages only while it waits for something."""

    def __init__(self, namespace: str = '', patience: float = 60.0) -> None:
        """Create the node; a wait of more than *patience* s raises PamError."""
        self.context = rclpy.Context()
        rclpy.init(context=self.context)
        name = f'pam_client_{os.getpid()}_{next(_numbers)}'
        self.node = rclpy.create_node(name, context=self.context, namespace=namespace)
        self._patience = patience
        self._executor = EventsExecutor(context=self.context)
        self._executor.add_node(self.node)
        self._publishers: dict[str, Any] = {}

    def __enter__(self) -> 'Client':
        """Return the client."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Release the node."""
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self.context)

    def until(self, condition: Callable[[], T], what: str) -> T:
        """Handle messages until *condition* returns a true value, and return this value.

        Raises PamError, which names *what* is missing, after the client's patience.
        """
        end = monotonic() + self._patience
        while not (result := condition()):
            if monotonic() > end:
                raise PamError(f'timed out after {self._patience:g} s while waiting for {what}')
            self._turn(TURN)
        return result

    def work(self, seconds: float) -> None:
        """Handle messages for this number of seconds."""
        end = monotonic() + seconds
        while (rest := end - monotonic()) > 0.0:
            self._turn(min(rest, TURN))

    def _turn(self, seconds: float) -> None:
        with held_back():
            self._executor.spin_once(timeout_sec=seconds)

    def collect(self, kind: type, topic: str) -> list[Any]:
        """Subscribe, and return the list to which each message will be appended."""
        messages: list[Any] = []
        self.node.create_subscription(kind, topic, messages.append, QoSProfile(depth=DEPTH))
        return messages

    def more(self, messages: list[Any], count: int = 1) -> None:
        """Wait until *messages* has *count* more messages than now."""
        wanted = len(messages) + count
        self.until(lambda: len(messages) >= wanted, f'{count} messages more')

    def publish(self, message: Any, topic: str) -> None:
        """Publish; before the first message, wait for a subscriber of *topic*."""
        if topic not in self._publishers:
            self._publishers[topic] = self.node.create_publisher(type(message), topic, 10)
            self.until(self._publishers[topic].get_subscription_count, f'a subscriber of {topic}')
        self._publishers[topic].publish(message)

    def delivered(self, topic: str, patience: Duration) -> None:
        """Wait until all messages that were published on *topic* have arrived."""
        if not self._publishers[topic].wait_for_all_acked(patience):
            raise PamError(f'messages that were published on {topic} have not arrived')

    def call(self, kind: Any, service: str, **request: Any) -> Any:
        """Call a service and return its response; call a Trigger only once: it could act twice."""
        client = self.node.create_client(kind, service)
        self.until(client.service_is_ready, f'the service {service}')
        message = kind.Request(**request)
        response = self.answer(lambda: client.call_async(message), service, kind is not Trigger)
        self.node.destroy_client(client)
        return response

    def answer(self, ask: Callable[[], Any], service: str, may_repeat: bool = True) -> Any:
        """Return the result of the first future of *ask* that is done.

        The middleware drops the answer of a server that has not yet discovered this client. If
        *may_repeat*, *ask* is therefore called again when no answer arrives.
        """
        futures: list[Any] = []
        called = 0.0

        def answered() -> Any:
            nonlocal called
            if not futures or (may_repeat and monotonic() > called + AGAIN):
                called = monotonic()
                futures.append(ask())
            return next((future for future in futures if future.done()), None)

        return self.until(answered, f'the answer of {service}').result()
