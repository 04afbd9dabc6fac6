# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How late a message arrives, from its stamp.

The clock of the stamps need not agree with that of this computer: a message is late by the time
that its delay, receipt minus stamp, exceeds the shortest delay known.
"""

# ns in which the shortest delay of states rises by 1 ns: after a delay has become longer by 0.1 s
# for good, the states count as late for another 2 s.
DRIFT = 20


class ShortestDelay:
    """The shortest delay of the messages of one source, from their stamps.

    All times are ns. The shortest delay rises by 1 ns in *drift* ns: then clocks that run apart
    more slowly, and a delay that has become longer for good, do not make messages late for ever.
    """

    def __init__(self, drift: int) -> None:
        """Begin without a message."""
        self._drift = drift
        self._shortest: int | None = None
        self._noted = 0

    def late(self, stamp: int, now: int) -> int:
        """Return by how much a message that arrives *now* is late, below 0 if none was faster."""
        if self._shortest is None:
            return 0
        return now - stamp - self._shortest - (now - self._noted) // self._drift

    def note(self, stamp: int, now: int) -> int:
        """Take the delay of a message that arrives *now* into account; return :meth:`late`."""
        late = self.late(stamp, now)
        self._shortest, self._noted = now - stamp - max(late, 0), now
        return late


class Lateness:
    """By how much the states of a rig are late."""

    def __init__(self) -> None:
        """Begin without a state."""
        self._delay, self._newest = ShortestDelay(DRIFT), 0

    def of(self, stamp: int, now: int) -> int:
        """Return by how many ns a state that arrives *now* is late; 0 without a stamp.

        A stamp before the last one is of a clock that was set back, and is not late.
        """
        if not stamp:
            return 0
        if stamp < self._newest:
            self._delay = ShortestDelay(DRIFT)
        self._newest = stamp
        return max(self._delay.note(stamp, now), 0)
