# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The subscriptions of a controller, which separate new messages from those of a silence."""

from collections.abc import Callable
from functools import partial
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from pam_ros.nodes.common.qos import DEPTH, open_qos
from pam_ros.nodes.common.stamps import stamp_of
from pam_ros.timing.pace import SECOND
from pam_ros.timing.silence import Silence, steady_ns

# ns of silence after which only the newest state is answered, if time follows the states: a
# scaled simulation has continued meanwhile, one in lockstep has waited and loses nothing.
HELD_UP = SECOND // 2


class Intake:
    """Subscribes to topics, and checks for silences of this process before each message."""

    def __init__(
        self,
        node: Node,
        is_followed: bool,
        longest: Callable[[], float],
        on_silence: Callable[[int], None],
    ) -> None:
        """Subscribe with *node*; *is_followed* means that time follows the states.

        If it does not, *on_silence*(ns) is called after a silence of more than *longest*() s.
        """
        self._node, self._is_followed = node, is_followed
        self._longest, self._on_silence = longest, on_silence
        self._silence = Silence(steady_ns())
        self.silent = 0  # length of the last silence, ns
        self._newest: dict[str, Callable[[], None]] = {}

    def look(self) -> bool:
        """Return whether this process was silent for longer than the rig continues by itself."""
        longest = HELD_UP if self._is_followed else round(self._longest() * SECOND)
        silent = self._silence.find(steady_ns(), longest)
        if self._is_followed:
            return False  # the simulated time between two states shows a silence
        if silent:
            self.silent = silent
            self._on_silence(silent)
        return bool(silent)

    def mark(self, now: int) -> None:
        """Note that the work of *now* ns is done.

        When all queued messages have arrived, pass on those that were kept until then.
        """
        self._silence.mark(now)
        if self._newest and not self._silence.is_settling:
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
        """Call *callback* with each measurement on *topic*, except old ones from a silence.

        If time follows the states, the newest of the queued measurements is used, too.
        """

        def receive(message: Any) -> None:
            stamp = stamp_of(message) if hasattr(message, 'header') else 0
            if self._is_followed and self._silence.is_settling:
                self._newest[topic] = partial(callback, message)
            elif self._is_followed or not self._silence.is_old(topic, stamp, steady_ns()):
                callback(message)

        # If time follows the states, it would stop at a lost state. A rig in real time publishes
        # the next one soon, reliably or not: best effort receives from both kinds of publishers.
        reliable, best_effort = ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT
        self.subscribe(kind, topic, receive, reliable if self._is_followed else best_effort)
