# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Detect whether a rig that is vented has ended, and another one has replaced it."""

from collections.abc import Sequence

from rclpy.node import Node
from rclpy.publisher import Publisher


class RigWatch:
    """Detects that a new rig has started, before it can receive a command for the old one.

    The node of a simulator is discovered some time before it subscribes. If a simulator was
    killed, a check for new subscribers is too late: the new simulator uses the port of the old
    one, and receives the messages that are still sent to it. If a rig ended properly, this check
    is enough.
    """

    def __init__(self, node: Node, states: str, publishers: Sequence[Publisher]) -> None:
        """Watch for the node that publishes *states* and the subscribers of *publishers*."""
        self._node, self._states, self._publishers = node, states, publishers
        self._names: set[tuple[str, str]] = set()
        self._fewest = [0, 0]
        self._since: float | None = None

    def is_new(self, since: float) -> bool:
        """Return whether another rig has started since the time *since* in s, when venting began.

        This is so if there are more nodes or subscribers than the smallest number since then. The
        rig that exists when a new time is given is the one that is vented.
        """
        if since != self._since:
            found = self._node.get_publishers_info_by_topic(self._states)
            self._names = {(info.node_name, info.node_namespace) for info in found}
            self._since, self._fewest = since, self._count()
            return False
        now = self._count()
        self._fewest = [min(pair) for pair in zip(self._fewest, now, strict=True)]
        return now != self._fewest

    def _count(self) -> list[int]:
        nodes = self._node.get_node_names_and_namespaces()
        return [
            sum(name in self._names for name in nodes),
            sum(one.get_subscription_count() for one in self._publishers),
        ]
