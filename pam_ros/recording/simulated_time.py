# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What simulated time it was when a message was sent, whenever that is found out."""

from bisect import bisect_right

KEPT = 4096  # times that are remembered


class SimulatedTime:
    """Follows ``/clock``: each of its messages, and all others, tell when they were sent.

    Between two of them simulated time is taken to pass evenly. All times are ns; those of sending
    are of one clock, the system's.
    """

    def __init__(self) -> None:
        """Begin without having heard of any time."""
        self._sent: list[int] = []
        self._time: list[int] = []

    def tell(self, sent: int, time: int) -> None:
        """Take in a *time* of ``/clock`` that was *sent* then; one out of order is left out."""
        if self._sent and sent <= self._sent[-1]:
            return
        self._sent.append(sent)
        self._time.append(time)
        if len(self._sent) > 2 * KEPT:
            del self._sent[:KEPT], self._time[:KEPT]

    def at(self, sent: int) -> int | None:
        """Return the time of what was *sent* then, None until a later time was published."""
        n = bisect_right(self._sent, sent)
        if n == len(self._sent):
            return None
        if n == 0:
            return self._time[0]
        begin, end = self._time[n - 1], self._time[n]
        if end <= begin:  # it stands still, or has begun anew
            return begin
        share = (sent - self._sent[n - 1]) / (self._sent[n] - self._sent[n - 1])
        return begin + round(share * (end - begin))

    def before(self, sent: int) -> int:
        """Return the last time that was published before *sent*, 0 where there is none."""
        n = bisect_right(self._sent, sent)
        return self._time[n - 1] if n else 0
