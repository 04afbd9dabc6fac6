# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a rig that is vented has ended, and another one has come in its place."""

from collections.abc import Sequence

from rclpy.node import Node
from rclpy.publisher import Publisher


class RigWatch:
    """Sees that a rig has started, before a command can reach it that was not meant for it.

    The node of a simulator is known some time before it subscribes. A subscriber that is new to
    us is too late where a simulator was killed: the new one has its port, and receives what is
    still sent to the one before. It is enough for a rig that ended as it should.
    """

    def __init__(self, node: Node, states: str, publishers: Sequence[Publisher]) -> None:
        """Watch for the node that publishes *states* and the subscribers of *publishers*."""
        self._node, self._states, self._publishers = node, states, publishers
        self._names: set[tuple[str, str]] = set()
        self._fewest = [0, 0]
        self._since: float | None = None

    def is_new(self, since: float) -> bool:
        """Say whether another rig has come since the time *since* in s, when venting began.

        That is so where there are more nodes or subscribers than the fewest since then. The rig
        that is there when a new time is given is the one that is vented.
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
