# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Detect whether a rig that is vented has ended, and another one has replaced it."""

from collections.abc import Sequence

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher

from pam_ros.timing.interruption import steady_ns
from pam_ros.timing.pace import SECOND

# ns without a moment at which all commands were acknowledged, after which the rig does not receive
# them. A rig acknowledges a command within some ms, and no program starts in so short a time.
PATIENCE = SECOND // 5
AT_ONCE = Duration()


class RigWatch:
    """Detects that a new rig has started, before it can receive a command for the old one.

    If a rig ends properly, the middleware sends its commands to no one any more, and a new rig
    receives commands only after it was discovered. If a rig is killed, the middleware does not
    know it for some 20 s and continues to send. A new rig can use the same port, and it can then
    receive these messages before it is discovered. But a rig that was killed acknowledges
    nothing, so that commands can stop before a new one starts.
    """

    def __init__(self, node: Node, states: str, publishers: Sequence[Publisher]) -> None:
        """Watch for the node that publishes *states* and the subscribers of *publishers*."""
        self._node, self._states, self._publishers = node, states, publishers
        self._names: set[tuple[str, str]] = set()
        self._fewest = [0, 0]
        self._since: float | None = None
        self._acknowledged = 0  # steady time, ns

    def is_new(self, since: float) -> bool:
        """Return whether another rig has started since the time *since* in s, when venting began.

        This is so if there are more nodes or subscribers than the smallest number since then. The
        rig that exists when a new time is given is the one that is vented.
        """
        if since != self._since:
            found = self._node.get_publishers_info_by_topic(self._states)
            self._names = {(info.node_name, info.node_namespace) for info in found}
            self._since, self._fewest = since, self._count()
            self._acknowledged = steady_ns()
            return False
        now = self._count()
        self._fewest = [min(pair) for pair in zip(self._fewest, now, strict=True)]
        return now != self._fewest

    def is_received(self) -> bool:
        """Return whether all reliable subscribers have acknowledged the commands recently.

        Best-effort subscribers acknowledge nothing, and count as if they had received all.
        """
        now = steady_ns()
        if all(one.wait_for_all_acked(AT_ONCE) for one in self._publishers):
            self._acknowledged = now
        return now - self._acknowledged <= PATIENCE

    def _count(self) -> list[int]:
        nodes = self._node.get_node_names_and_namespaces()
        return [
            sum(name in self._names for name in nodes),
            sum(one.get_subscription_count() for one in self._publishers),
        ]
