# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Checks once a second which nodes publish and subscribe to a node's topics."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from rclpy.node import Node

from pam_ros.health import topics as topic_health
from pam_ros.health.health import Health
from pam_ros.health.topics import Senders, TopicHealth, names_one_of
from pam_ros.nodes.common.sampler import Sampler

# Topics of a node that are sampled at a time: the start takes some 7 ms, then a sample below 1 ms.
# Nodes that share more topics than these also share these.
SAMPLED = 4
UNKNOWN = '_NODE_NAME'  # start of the name that rmw gives to a node it has not discovered yet


class Watched(NamedTuple):
    """A topic that only one node may publish."""

    kind: type
    name: str
    joints: tuple[str, ...] = ()  # for joint states: other nodes may publish other joints
    is_command: bool = False  # to which a node of the rig must subscribe


def never() -> bool:
    """Return False: no command is published."""
    return False


class TopicWatch:
    """Checks topics in :meth:`health`, which must be called once a second.

    Messages are sampled only while a topic has more than one publisher: their sequence numbers
    show whether more than one of them sends.
    """

    def __init__(
        self, node: Node, watched: Sequence[Watched], is_commanding: Callable[[], bool] = never
    ) -> None:
        """Check the topics of *node*; *is_commanding* returns whether it publishes commands."""
        self._node, self._is_commanding = node, is_commanding
        self._sampler = Sampler(node)
        self._each = [_Topic(node, one, self._sampler) for one in watched]

    def health(self) -> Health:
        """Check now; return the health of all topics. Faults are logged when they begin."""
        is_commanding, left = self._is_commanding(), SAMPLED
        for topic in self._each:
            topic.count()
            is_sampled = topic.publishers > 1 and left > 0
            left -= is_sampled
            for sentence in topic.look(is_commanding=is_commanding, is_sampled=is_sampled):
                self._node.get_logger().warning(sentence)
        return topic_health.topics(
            [topic.health for topic in self._each], [topic.publishers for topic in self._each]
        )

    def close(self) -> None:
        """Release the sampler of the topics: must be called before the node is destroyed."""
        self._sampler.close()


class _Topic:
    def __init__(self, node: Node, watched: Watched, sampler: Sampler) -> None:
        self._node, self._watched, self._sampler = node, watched, sampler
        self.health = TopicHealth(node.resolve_topic_name(watched.name), watched.joints)
        self.publishers = 0
        self._senders = Senders()
        self._is_sampled = False

    def count(self) -> None:
        """Count the publishers."""
        self.publishers = self._node.count_publishers(self.health.topic)

    def look(self, *, is_commanding: bool, is_sampled: bool) -> list[str]:
        """Note the present state of the topic; return the sentences for the log."""
        nodes = self._publishing_nodes() if is_sampled else []
        has_several = self._has_several_senders(is_sampled=is_sampled)
        lacks_subscriber = (
            self._watched.is_command and is_commanding and not self._has_subscriber()
        )
        return self.health.look(nodes, lacks_subscriber, has_several)

    def _publishing_nodes(self) -> list[str]:
        infos = self._node.get_publishers_info_by_topic(self.health.topic)
        return [_name_of(info) for info in infos]

    def _has_subscriber(self) -> bool:
        """Return whether a node subscribes that is not hidden; samplers and tools are hidden."""
        infos = self._node.get_subscriptions_info_by_topic(self.health.topic)
        return any(
            info.node_name.startswith(UNKNOWN) or not info.node_name.startswith('_')
            for info in infos
        )

    def _has_several_senders(self, *, is_sampled: bool) -> bool:
        """Return whether more than one publisher sends, from a sample of the newest messages."""
        was_sampled, self._is_sampled = self._is_sampled, is_sampled
        if not is_sampled:
            self._sampler.leave(self.health.topic)
            return False
        if not was_sampled:
            self._senders = Senders()
        for message, number in self._sampler.take(self._watched.kind, self.health.topic):
            if not self._watched.joints or names_one_of(self._watched.joints, message):
                self._senders.take(number)
        return self._senders.are_several()


def _name_of(info: Any) -> str:
    """Return the full name of a node, '' if it is not discovered yet."""
    if info.node_name.startswith(UNKNOWN):
        return ''
    return f'{info.node_namespace.rstrip("/")}/{info.node_name}'
