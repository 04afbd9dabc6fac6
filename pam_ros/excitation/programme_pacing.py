# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The two kinds of pacing of a programme: its own rate, or one command for each joint state.

All times are s, except stamps.
"""

from abc import abstractmethod
from collections.abc import Callable
from time import monotonic_ns
from typing import NamedTuple

from pam_ros.timing.pace import SECOND
from pam_ros.timing.pacing import Pacing, Reply


class Received(NamedTuple):
    """A state that was received: its time by the clock of the programme, and what it leads to."""

    time: float
    reply: Reply


class ProgrammePacing(Pacing):
    """Which time the programme has, and which states it answers."""

    @abstractmethod
    def now(self) -> float:
        """Return the time by the clock of the programme; 0 means that the clock has no time."""

    @abstractmethod
    def receive(self, stamp: int) -> Received:
        """Note that a state of *stamp* in ns, 0 if it has none, arrives now."""

    @property
    @abstractmethod
    def start(self) -> float:
        """The time at which a programme starts that starts now."""

    @property
    @abstractmethod
    def silent_until(self) -> float:
        """The time until which no state has arrived since the newest one."""

    @abstractmethod
    def silence(self, patience: float) -> str:
        """Return a sentence if no state has arrived for *patience* s of wall time, else ''.

        It is '' as well if the programme has the time of the wall clock.
        """


class OwnRate(ProgrammePacing):
    """The programme has a rate of its own on the wall clock."""

    answers_states = False

    def __init__(self, steady: Callable[[], int] = monotonic_ns) -> None:
        """Begin without a state; *steady* returns ns of a clock that never jumps."""
        super().__init__(steady)

    def now(self) -> float:
        """Return the steady time."""
        return self._steady() / SECOND

    def receive(self, stamp: int) -> Received:
        """Return the time of receipt; the next tick sends the next command."""
        return Received(self.now(), self.reply_to_state(is_repeated=False))

    @property
    def start(self) -> float:
        """The steady time."""
        return self.now()

    @property
    def silent_until(self) -> float:
        """The steady time."""
        return self.now()

    def silence(self, patience: float) -> str:
        """Return ''."""
        return ''


class OneCommandPerState(ProgrammePacing):
    """The programme has the time of the states, and answers each new one with one command."""

    answers_states = True

    def __init__(self, ros: Callable[[], int], steady: Callable[[], int] = monotonic_ns) -> None:
        """Begin without a state; *ros* returns the ROS time in ns.

        *steady* returns ns of a clock that never jumps.
        """
        super().__init__(steady)
        self._ros = ros
        self._stamp = 0
        self._received = steady()  # steady time of the newest state, ns
        self._seen = self.now()  # its time by the clock of the programme

    def now(self) -> float:
        """Return the ROS time."""
        return self._ros() / SECOND

    def receive(self, stamp: int) -> Received:
        """Return the time of the stamp; without a stamp, the ROS time."""
        is_repeated = bool(stamp) and stamp == self._stamp
        self._stamp, self._received = stamp, self._steady()
        self._seen = stamp / SECOND if stamp else self.now()
        return Received(self._seen, self.reply_to_state(is_repeated=is_repeated))

    @property
    def start(self) -> float:
        """The time of the newest state, which waits for a command."""
        return self._stamp / SECOND if self._stamp else self.now()

    @property
    def silent_until(self) -> float:
        """The smaller of two times: time may stop, and /clock may arrive before its states."""
        return min(self.now(), self._seen + self._age)

    def silence(self, patience: float) -> str:
        """Return a sentence if no state has arrived for *patience* s of wall time, else ''."""
        return (
            f'no joint_states for {self._age:.1f} s of wall time' if self._age > patience else ''
        )

    @property
    def _age(self) -> float:
        return (self._steady() - self._received) / SECOND


def programme_pacing(ros: Callable[[], int], *, is_simulated: bool) -> ProgrammePacing:
    """Return the pacing of a programme; *is_simulated* means that the rig makes the time.

    *ros* returns the ROS time in ns.
    """
    return OneCommandPerState(ros) if is_simulated else OwnRate()
