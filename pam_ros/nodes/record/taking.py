# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A topic that is recorded: what is known of its times, and what waits to be written."""

from collections import deque

from rclpy.subscription import Subscription

from pam_ros.recording.sending_time import SendingTime


class RecordedTopic:
    """A topic that is recorded. All times are system times in ns."""

    def __init__(self, subscription: Subscription, channel: int) -> None:
        self.subscription, self.channel = subscription, channel
        self.is_sole = False  # whether it has only one publisher
        self.last_number: int | None = None
        self.lost = 0
        self.sending = SendingTime()
        self._count = 0
        self._first_sent = self._last_sent = 0
        # Taken, but simulated time is not yet known: data, system time of sending, time taken, ns.
        self.waiting: deque[tuple[bytes, int, int]] = deque()

    def count(self, sent: int) -> None:
        """Count a message that was sent at *sent*."""
        self._count += 1
        self._first_sent = self._first_sent or sent
        self._last_sent = sent

    def may_miss(self, until: int, period: int, patience: int) -> bool:
        """Return whether messages that were sent before *until* may still arrive.

        The middleware delivers the messages of a publisher in their order. Therefore nothing is
        missing after a message that was sent later. Only a topic with a mean period of at most
        *period* is expected to have such a message, and only if it was still published less than
        *patience* before: a lost message is sent again within this time.
        """
        if self._count < 2 or not until - patience < self._last_sent < until:
            return False
        return self._last_sent - self._first_sent <= period * (self._count - 1)

    def count_lost(self, number: int | None) -> None:
        """Count the messages between the last number of its one publisher and *number*."""
        if number is None:
            return
        if self.is_sole and self.last_number is not None and number > self.last_number:
            self.lost += number - self.last_number - 1
        self.last_number = number
