# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Takes the newest messages of topics from time to time, without a callback for each."""

from itertools import islice
from typing import NamedTuple

from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from pam_ros.nodes.common.rclpy_internals import messages_of

# Messages that are stored between two samples: those of a second at 250 Hz. To take so many costs
# a node about 1 ms.
KEPT = 250


class Sample(NamedTuple):
    """A serialized message, and its number among those of its publisher.

    The number is None where the middleware does not number messages.
    """

    message: bytes
    number: int | None


class Sampler:
    """A hidden node that no executor serves, with a subscription for each topic that is sampled.

    The executor of this package's nodes does not pass the number of a message to a callback, and a
    callback for each message would cost a control loop too much time. The hidden node exists only
    while topics are sampled.
    """

    def __init__(self, node: Node) -> None:
        """Sample topics next to *node*."""
        self._owner = node
        self._node: Node | None = None
        self._subscriptions: dict[str, Subscription] = {}

    def take(self, kind: type, topic: str) -> list[Sample]:
        """Return the newest messages of *topic*, a full name, in the order of their arrival.

        These are the messages since the last call; the first call subscribes and returns none.
        """
        if topic not in self._subscriptions:
            quality = QoSProfile(depth=KEPT, reliability=ReliabilityPolicy.BEST_EFFORT)
            self._subscriptions[topic] = self._hidden().create_subscription(
                kind, topic, lambda message: None, quality, raw=True
            )
        return [
            Sample(message, info['publication_sequence_number'])
            for message, info in islice(messages_of(self._subscriptions[topic]), KEPT)
        ]

    def _hidden(self) -> Node:
        if self._node is None:
            self._node = Node(
                f'_{self._owner.get_name()}_sampler',
                context=self._owner.context,
                namespace=self._owner.get_namespace(),
                use_global_arguments=False,  # which rename nodes and topics
                enable_rosout=False,
                start_parameter_services=False,
                parameter_overrides=[Parameter('start_type_description_service', value=False)],
            )
        return self._node

    def leave(self, topic: str) -> None:
        """Sample *topic* no longer."""
        subscription = self._subscriptions.pop(topic, None)
        if subscription is not None and self._node is not None:
            self._node.destroy_subscription(subscription)
        if not self._subscriptions:
            self.close()

    def close(self) -> None:
        """Release all subscriptions and the hidden node."""
        self._subscriptions = {}
        if self._node is not None:
            self._node.destroy_node()
            self._node = None
