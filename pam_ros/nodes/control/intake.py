# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The subscriptions of a controller, which leave out old messages after an interruption."""

from collections.abc import Callable
from functools import partial
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from pam_ros.nodes.common.qos import DEPTH, open_qos
from pam_ros.nodes.common.stamps import stamp_of
from pam_ros.timing.interruption import Interruptions, steady_ns
from pam_ros.timing.pace import SECOND

# ns of interruption after which only the newest state is answered, if time follows the states: a
# scaled simulation has continued meanwhile; one in lockstep has waited, and no state is lost.
LONG = SECOND // 2


class StateIntake:
    """Subscribes to topics, and checks for interruptions of this process before each message."""

    def __init__(
        self,
        node: Node,
        is_followed: bool,
        longest: Callable[[], float],
        on_pause: Callable[[int], None],
    ) -> None:
        """Subscribe with *node*; *is_followed* means that time follows the states.

        If it does not, *on_pause*(ns) is called after an interruption of more than *longest*() s.
        """
        self._node, self._is_followed = node, is_followed
        self._longest, self._on_pause = longest, on_pause
        self._interruptions = Interruptions(steady_ns())
        self.pause = 0  # length of the last interruption, ns
        self._newest: dict[str, Callable[[], None]] = {}

    def look(self) -> bool:
        """Return whether an interruption was longer than the rig keeps the last command."""
        longest = LONG if self._is_followed else round(self._longest() * SECOND)
        pause = self._interruptions.find(steady_ns(), longest)
        if self._is_followed:
            return False  # the simulated time between two states shows an interruption
        if pause:
            self.pause = pause
            self._on_pause(pause)
        return bool(pause)

    def mark(self, now: int) -> None:
        """Note that the work of *now* ns is done.

        When all queued messages have arrived, pass on those that were kept until then.
        """
        self._interruptions.mark(now)
        if self._newest and not self._interruptions.is_settling:
            newest, self._newest = self._newest, {}
            for take in newest.values():
                take()

    def subscribe(
        self,
        kind: type,
        topic: str,
        callback: Callable[[Any], None],
        reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE,
        *,
        raw: bool = False,
    ) -> None:
        """Call *callback* with each message of *topic*, or with its bytes if *raw*."""

        def receive(message: Any) -> None:
            self.look()
            callback(message)

        quality = QoSProfile(depth=DEPTH, reliability=reliability)
        self._node.create_subscription(
            kind, topic, receive, quality, qos_overriding_options=open_qos(), raw=raw
        )

    def measure(self, kind: type, topic: str, callback: Callable[[Any], None]) -> None:
        """Call *callback* with each measurement on *topic*, except old ones.

        Those from before the end of an interruption are old. If time follows the states, the
        newest of the queued measurements is used, too.
        """

        def receive(message: Any) -> None:
            stamp = stamp_of(message) if hasattr(message, 'header') else 0
            if self._is_followed and self._interruptions.is_settling:
                self._newest[topic] = partial(callback, message)
            elif self._is_followed or not self._interruptions.is_old(topic, stamp, steady_ns()):
                callback(message)

        # If time follows the states, it would stop at a lost state. A rig in real time publishes
        # the next one soon, reliably or not: best effort receives from both kinds of publishers.
        reliable, best_effort = ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT
        self.subscribe(kind, topic, receive, reliable if self._is_followed else best_effort)
