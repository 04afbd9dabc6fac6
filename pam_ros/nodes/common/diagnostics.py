# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Publish the health of a node on ``/diagnostics`` once a second."""

from collections.abc import Callable, Mapping
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.time import Time

from pam_ros.health.health import Health, Level

PERIOD = 1.0  # s
LEVELS = {
    Level.OK: DiagnosticStatus.OK,
    Level.WARN: DiagnosticStatus.WARN,
    Level.ERROR: DiagnosticStatus.ERROR,
}


class Diagnostics:
    """Publishes the health of a node's parts, each named ``node: part``."""

    def __init__(
        self,
        node: Node,
        parts: Mapping[str, Callable[[], Health]],
        now: Callable[[], Time] | None = None,
    ) -> None:
        """Publish the health of *parts* once a second, by the steady clock.

        *now* returns the time for the stamp, if it is not the time of the node's clock.
        """
        self._parts = parts
        self._now = now or node.get_clock().now
        self._name = node.get_fully_qualified_name().lstrip('/')
        self._publisher = node.create_publisher(DiagnosticArray, '/diagnostics', 10)
        self._timer = node.create_timer(
            PERIOD, self.publish, clock=Clock(clock_type=ClockType.STEADY_TIME)
        )

    def publish(self) -> None:
        """Publish the health of all parts now."""
        message = DiagnosticArray()
        message.header.stamp = self._now().to_msg()
        for part, health_of in self._parts.items():
            health = health_of()
            values = [KeyValue(key=k, value=text(v)) for k, v in health.values.items()]
            message.status.append(
                DiagnosticStatus(
                    level=LEVELS[health.level],
                    name=f'{self._name}: {part}',
                    message=health.message,
                    hardware_id=self._name,
                    values=values,
                )
            )
        self._publisher.publish(message)


def text(value: Any) -> str:
    """Return the text of a value in a diagnostic; '' for None, a list for a tuple."""
    if value is None:
        return ''
    if isinstance(value, tuple):
        return f'({", ".join(text(one) for one in value)})'
    return f'{value:.6g}' if isinstance(value, float) else str(value)
