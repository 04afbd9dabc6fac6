# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Takes the newest messages of a topic from time to time, without a callback for each."""

from itertools import islice
from typing import NamedTuple

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

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
    """A subscription of a hidden node that no executor serves.

    The executor of this package's nodes does not pass the number of a message to a callback, and a
    callback for each message would cost a control loop too much time.
    """

    def __init__(self, node: Node, kind: type, topic: str) -> None:
        """Subscribe to *topic*, a full name, with a hidden node next to *node*."""
        self._node = Node(
            f'_{node.get_name()}_sampler',
            context=node.context,
            namespace=node.get_namespace(),
            use_global_arguments=False,  # which rename nodes and topics
            enable_rosout=False,
            start_parameter_services=False,
        )
        quality = QoSProfile(depth=KEPT, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._subscription = self._node.create_subscription(
            kind, topic, lambda message: None, quality, raw=True
        )

    def take(self) -> list[Sample]:
        """Return the newest messages since the last call, in the order of their arrival."""
        return [
            Sample(message, info['publication_sequence_number'])
            for message, info in islice(messages_of(self._subscription), KEPT)
        ]

    def close(self) -> None:
        """Release the subscription and its node."""
        self._node.destroy_node()
