# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Lockstep: the simulator continues when all muscles were commanded."""

from time import monotonic_ns

from rclpy.node import Node
from rclpy.subscription import Subscription

from pam_ros.timing.pace import SECOND

# ns after which the state is published again for a controller that has not answered
REPEAT = SECOND // 2
PATIENCE = SECOND  # ns of waiting after which the diagnostics report it
SETTLE = SECOND // 4  # ns within which all answers to a repeated state arrive


class Turns:
    """Counts the muscles that were commanded in this period, and watches which nodes command.

    A controller that starts late, or replaces one that ended, has not received the state that
    waits for an answer. This state must be published again until an answer arrives. For a
    controller that has answered, it is never published twice, however long the controller
    computes.

    A controller may have sent more than one command if it was just found, if time continues after
    a pause, or if the rig was reset. Then all commands within SETTLE are one answer, and the last
    one counts.
    """

    def __init__(self, node: Node, muscles: int) -> None:
        """Start without commands."""
        self._node, self._muscles = node, muscles
        self._topics: list[str] = []
        self._answered: set[int] = set()
        self._known: frozenset[bytes] = frozenset()
        self._has_answered = False
        self._settled = 0  # steady time until which answers are collected, ns
        self.begin()

    def watch(self, subscription: Subscription) -> None:
        """Look for controllers among the publishers of this subscription's topic."""
        self._topics.append(subscription.topic_name)

    def begin(self) -> None:
        """Wait for commands from now on: the state was published."""
        self._answered.clear()
        self._since = self._published = monotonic_ns()

    def take(self, muscle: int | None) -> None:
        """Note the command of one muscle, or of all muscles (None)."""
        if not self._has_answered:
            self.settle()
        self._has_answered = True
        if muscle is None:
            self._answered.update(range(self._muscles))
        else:
            self._answered.add(muscle)

    def settle(self) -> None:
        """Collect commands for SETTLE ns, since more than one may arrive."""
        self._settled = monotonic_ns() + SETTLE

    @property
    def is_complete(self) -> bool:
        """Whether all muscles were commanded, and no other command for this state is expected."""
        return len(self._answered) == self._muscles and monotonic_ns() >= self._settled

    @property
    def waited(self) -> float:
        """Seconds since the state was published."""
        return (monotonic_ns() - self._since) / SECOND

    @property
    def complaint(self) -> str:
        """A sentence on a long wait for commands, '' if there is none."""
        left = self._muscles - len(self._answered)
        if not left or monotonic_ns() - self._since < PATIENCE:
            return ''
        if not self._known:
            return (
                f'waits for a controller, {self.waited:.1f} s so far: no node publishes commands'
            )
        return f'waits for commands, {self.waited:.1f} s so far: {left} of {self._muscles} missing'

    def must_repeat(self) -> bool:
        """Return whether to publish the state again now; to be called a few times per second."""
        known = frozenset(
            bytes(info.endpoint_gid)
            for topic in self._topics
            for info in self._node.get_publishers_info_by_topic(topic)
        )
        is_new = bool(known - self._known)
        self._known = known
        if is_new or not known:
            self._has_answered = False
        now = monotonic_ns()
        if self._has_answered or not (is_new or now - self._published > REPEAT):
            return False
        self._published = now
        return True
