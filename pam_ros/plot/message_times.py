# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The times of the messages of a running rig on the axis of a plot.

They are found like those of a recording: the stamps of headers where they are filled and of one
clock, else the time at which a message was sent, as ``pam_record`` finds it. All times are in ns.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from pam_ros.plot.restarts import BACK
from pam_ros.recording.bag.clocks import LATENCY, SIMULATED
from pam_ros.recording.sending_time import SendingTime
from pam_ros.recording.simulated_time import SimulatedTime
from pam_ros.timing.pace import SECOND

RECENT = 10 * SECOND  # a topic without a message for so long has no influence on the others


class Arrived(NamedTuple):
    """A message: its stamp (0: none), and the system times of its sending and receipt."""

    topic: str
    stamp: int
    sent: int
    received: int


class Placed(NamedTuple):
    """The times of messages that arrived together, None for those that are not drawn.

    With ``begins_again`` all that was drawn before is of another time.
    """

    times: list[int | None]
    begins_again: bool


@dataclass(frozen=True)
class _Header:
    """The newest stamp of a topic: whether it is simulated, its least delay, its receipt."""

    is_simulated: bool
    late: int
    received: int


class MessageTimes:
    """Finds the times of messages.

    ``has_own_clock`` is true where the stamps themselves are the only clock of the axis, because
    the rig is in simulated time and this program is not; ``newest`` is the latest time. ``note``
    says why the stamps are not used; it is '' if they are.
    """

    def __init__(self, *, is_simulated: bool) -> None:
        """Use simulated time, that of ``/clock``, for the axis if *is_simulated*."""
        self._is_simulated = is_simulated
        self._has_clock = False  # a message of /clock was received
        self._clock = SimulatedTime()
        self._sending: dict[str, SendingTime] = {}  # of messages
        self._stamping: dict[str, SendingTime] = {}  # of stamps
        self._headers: dict[str, _Header] = {}
        self._last: dict[str, int] = {}
        self._axis: tuple[bool, bool] | None = None  # is simulated, and is that of the headers
        self.has_own_clock = False
        self.newest = 0
        self.note = ''

    def tell(self, sent: int, time: int) -> None:
        """Add a *time* of ``/clock`` that was *sent* at this system time."""
        if not self._has_clock:
            self._has_clock, self._clock = True, SimulatedTime()
        self._clock.tell(sent, time)

    def of(self, arrived: Sequence[Arrived]) -> Placed:
        """Return the times of messages that were taken together, in the order of sending."""
        for one in arrived:
            if one.stamp > 0:
                self._see(one)
        begins_again = self._choose_axis(max((one.received for one in arrived), default=0))
        if begins_again:
            self._forget()
        times: list[int | None] = []
        for one in arrived:
            time = self._time(one)
            if time is not None and time < self._last.get(one.topic, time) - BACK * SECOND:
                begins_again, times = True, [None] * len(times)
                self._forget()
            if time is not None:
                self._last[one.topic] = time
                self.newest = max(self.newest, time)
            times.append(time)
        return Placed(times, begins_again)

    def _see(self, one: Arrived) -> None:
        """Note the clock of a stamp, and learn the simulated time from it if nothing else does."""
        is_simulated = one.stamp < SIMULATED
        stamping = self._stamping.setdefault(one.topic, SendingTime())
        (time,) = stamping.of([(one.stamp, one.received)])
        self._headers[one.topic] = _Header(is_simulated, time - one.stamp, one.received)
        if is_simulated and not (self._has_clock or self._is_simulated):
            self._clock.tell(one.sent, one.stamp)

    def _choose_axis(self, now: int) -> bool:
        """Choose the clock of the axis, and whether stamps are used; return whether it changes."""
        recent = {k: one for k, one in self._headers.items() if now - one.received < RECENT}
        simulated = [topic for topic, one in recent.items() if one.is_simulated]
        real = [topic for topic, one in recent.items() if not one.is_simulated]
        self.note = ''
        if simulated and real:
            self.note = (
                f'{simulated[0]} has stamps in simulated time, and {real[0]} in real time: all '
                'messages have the time at which they were sent'
            )
        elif self._is_simulated and self._has_clock:
            newest = self._clock.before(now)
            other = real if newest < SIMULATED else simulated
            if other and newest:
                self.note = (
                    f'{other[0]} has stamps of another clock than /clock: all messages have the '
                    'simulated time at which they were sent'
                )
        elif not simulated:
            for topic in real:
                late = recent[topic].late / SECOND
                if not LATENCY[0] <= late <= LATENCY[1]:
                    self.note = (
                        f'{topic} was stamped by a clock {late:.4g} s behind that of this '
                        'machine: all messages have the time at which they were sent'
                    )
        is_simulated = self._is_simulated or bool(simulated and not real)
        self.has_own_clock = is_simulated and not self._is_simulated
        before, self._axis = self._axis, (is_simulated, not self.note)
        return before is not None and before != self._axis

    def _time(self, one: Arrived) -> int | None:
        """Return the time of a message on the axis, None if it is not known."""
        assert self._axis is not None
        is_simulated, uses_stamps = self._axis
        if one.stamp > 0 and uses_stamps:
            return one.stamp
        if is_simulated:
            time = self._clock.at(one.sent)
            return (self._clock.before(one.sent) if time is None else time) or None
        sending = self._sending.setdefault(one.topic, SendingTime())
        return sending.of([(one.sent, one.received)])[0]

    def _forget(self) -> None:
        self._last.clear()
        self.newest = 0
