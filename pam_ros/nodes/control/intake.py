# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The subscriptions of a controller, which leave out old messages after an interruption."""

from collections.abc import Callable
from functools import partial
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from pam_ros.nodes.common.qos import DEPTH, open_qos, states_reliability
from pam_ros.nodes.common.stamps import stamp_of
from pam_ros.timing.loop_pacing import LoopPacing, Use


class StateIntake:
    """Subscribes to topics, and checks for interruptions of this process before each message."""

    def __init__(self, node: Node, pacing: LoopPacing, on_pause: Callable[[int], None]) -> None:
        """Subscribe with *node*; *pacing* finds interruptions.

        *on_pause*(ns) is called after an interruption after which control starts again.
        """
        self._node, self._pacing, self._on_pause = node, pacing, on_pause
        self.pause = 0  # length of the last interruption, ns
        self._newest: dict[str, Callable[[], None]] = {}

    def look(self) -> bool:
        """Return whether an interruption was so long that control starts again."""
        pause = self._pacing.interruption()
        if pause:
            self.pause = pause
            self._on_pause(pause)
        return bool(pause)

    def mark(self, now: int) -> None:
        """Note that the work of *now* ns is done.

        When all queued messages have arrived, pass on those that were kept until then.
        """
        self._pacing.mark(now)
        if self._newest and not self._pacing.is_settling:
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
            use = self._pacing.use_of(topic, stamp)
            if use is Use.NOW:
                callback(message)
            elif use is Use.LATER:
                self._newest[topic] = partial(callback, message)

        reliability = states_reliability(are_answered=self._pacing.answers_states)
        self.subscribe(kind, topic, receive, reliability)
