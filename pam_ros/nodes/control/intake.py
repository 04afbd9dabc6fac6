# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The subscriptions of a controller, which tell what was sent before it woke from what is new."""

from collections.abc import Callable
from functools import partial
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from pam_ros.nodes.common.qos import DEPTH, open_qos
from pam_ros.nodes.common.stamps import stamp_of
from pam_ros.timing.pace import SECOND
from pam_ros.timing.silence import Silence, steady_ns

# ns of silence after which, where states make the time, only the newest state is answered: a
# scaled simulation has gone on meanwhile, one in lockstep has waited and loses nothing.
HELD_UP = SECOND // 2


class Intake:
    """Subscribes to topics, and looks for silences of this process before each message."""

    def __init__(
        self,
        node: Node,
        is_followed: bool,
        longest: Callable[[], float],
        on_silence: Callable[[int], None],
    ) -> None:
        """Subscribe with *node*; *is_followed* says that states make the time.

        Where they do not, *on_silence*(ns) is called after a silence of more than *longest*() s.
        """
        self._node, self._is_followed = node, is_followed
        self._longest, self._on_silence = longest, on_silence
        self._silence = Silence(steady_ns())
        self.silent = 0  # ns that the last silence was long
        self._newest: dict[str, Callable[[], None]] = {}

    def look(self) -> bool:
        """Say whether this process was silent for longer than the rig goes on by itself."""
        longest = HELD_UP if self._is_followed else round(self._longest() * SECOND)
        silent = self._silence.find(steady_ns(), longest)
        if self._is_followed:
            return False  # the simulated time that passes from one state to the next one tells
        if silent:
            self.silent = silent
            self._on_silence(silent)
        return bool(silent)

    def mark(self, now: int) -> None:
        """Note that the work of *now* ns is done, and take what was kept until the queue came."""
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
        """Call *callback* with each message of *topic*; with its bytes where *raw*."""

        def receive(message: Any) -> None:
            self.look()
            callback(message)

        quality = QoSProfile(depth=DEPTH, reliability=reliability)
        self._node.create_subscription(
            kind, topic, receive, quality, qos_overriding_options=open_qos(), raw=raw
        )

    def measure(self, kind: type, topic: str, callback: Callable[[Any], None]) -> None:
        """Call *callback* with each measurement on *topic* that is not of before the waking."""

        def receive(message: Any) -> None:
            stamp = stamp_of(message) if hasattr(message, 'header') else 0
            if self._is_followed and self._silence.is_settling:
                self._newest[topic] = partial(callback, message)
            elif self._is_followed or not self._silence.is_old(topic, stamp, steady_ns()):
                callback(message)

        # Where states make the time, one that is lost is one that is waited for. A rig in real
        # time publishes the next one soon, reliably or not: best effort receives from both.
        reliable, best_effort = ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT
        self.subscribe(kind, topic, receive, reliable if self._is_followed else best_effort)
