# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated time at which a message was sent, as soon as it is known."""

from array import array
from bisect import bisect_right

# Times that are kept, at least: a recorder that was delayed reads all of them before the messages
# that were sent between them. Faster than real time there are thousands in a second.
KEPT = 200_000


class SimulatedTime:
    """Convert the time at which a message was sent to simulated time, from ``/clock``.

    Between two messages of ``/clock``, simulated time is assumed to pass evenly. All times are in
    ns; the times of sending are those of one clock, the system's.
    """

    def __init__(self, kept: int = KEPT) -> None:
        """Start without any known time, and keep at least the last *kept* of them."""
        self._kept = kept
        self._sent = array('q')
        self._time = array('q')

    @property
    def newest(self) -> int | None:
        """The time of sending of the last known time, None before the first one."""
        return self._sent[-1] if self._sent else None

    def tell(self, sent: int, time: int) -> None:
        """Add a *time* of ``/clock`` that was sent at *sent*; one out of order is ignored."""
        if self._sent and sent <= self._sent[-1]:
            return
        self._sent.append(sent)
        self._time.append(time)
        if len(self._sent) > 2 * self._kept:
            del self._sent[: self._kept], self._time[: self._kept]

    def at(self, sent: int) -> int | None:
        """Return the time of a message sent at *sent*, None until a later time was published."""
        n = bisect_right(self._sent, sent)
        if n == len(self._sent):
            return None
        if n == 0:
            return self._time[0]
        begin, end = self._time[n - 1], self._time[n]
        if end <= begin:  # simulated time stands still, or has started again
            return begin
        share = (sent - self._sent[n - 1]) / (self._sent[n] - self._sent[n - 1])
        return begin + round(share * (end - begin))

    def before(self, sent: int) -> int:
        """Return the last time that was published at or before *sent*, 0 if there is none."""
        n = bisect_right(self._sent, sent)
        return self._time[n - 1] if n else 0
