# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The time at which a message was sent, on the clock of the recorder."""

from collections.abc import Sequence

WINDOW = 10_000_000_000  # ns of sending over which the least delay is taken, at least
# ns. A message that was lost is sent again within 3 s. A delay that differs by more than this from
# the least one means that a clock was set.
LIMIT = 5_000_000_000


class SendingTime:
    """Convert times of sending of one publisher to the clock of the recorder.

    The middleware gives the time at which a message was sent, on the clock of the publisher, and
    the time at which it was received, on the clock of the recorder. The time of receipt is late
    and can be out of order where a message was lost and sent again, or where the recorder was
    delayed. The difference of the two is the difference of the clocks and the delay of
    transmission. The least difference of the last 10 to 20 s has the least delay in it: added to
    a time of sending, it gives the time at which the message would have been received without any
    other delay. This is never later than the receipt. The window is short enough for clocks that
    drift by 50 us/s: 1 ms. All times are in ns.
    """

    def __init__(self) -> None:
        """Start without any known delay."""
        self._sent = self._time = 0  # of the last message
        self._begin: int | None = None  # time of sending at which the present window begins
        # Least differences, of the window before and of the present one.
        self._before = self._least = 0

    def of(self, messages: Sequence[tuple[int, int]]) -> list[int]:
        """Return the times of messages that were taken together, in the order of sending.

        Each is (time of sending, time of receipt). A lost message delays all that were sent after
        it; their receipt shows how late it is. A clock that is set begins anew with the time of
        receipt, which may be an earlier time.
        """
        least, starts = [], []
        for sent, received in messages:
            starts.append(self._begin is None or self._is_set(sent, received - sent))
            self._add(sent, received - sent, is_new=starts[-1])
            least.append(min(self._before, self._least))
        for i in range(len(least) - 1, 0, -1):
            if not starts[i]:
                least[i - 1] = min(least[i - 1], least[i])
        times = []
        for (sent, _), delay, is_new in zip(messages, least, starts, strict=True):
            time = sent + delay
            self._time = time if is_new else max(self._time, time)
            times.append(self._time)
        return times

    def _add(self, sent: int, delay: int, *, is_new: bool) -> None:
        """Add the delay of a message; *is_new* forgets all before."""
        if is_new or self._begin is None:
            self._begin, self._before, self._least = sent, delay, delay
        elif sent - self._begin >= WINDOW:
            self._begin, self._before, self._least = sent, self._least, delay
        else:
            self._least = min(self._least, delay)
        self._sent = sent

    def _is_set(self, sent: int, delay: int) -> bool:
        """Return whether one of the two clocks was set since the last message."""
        return sent < self._sent or abs(delay - min(self._before, self._least)) > LIMIT
