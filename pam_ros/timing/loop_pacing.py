# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The two kinds of pacing of a control loop: its own rate, or one step for each joint state.

They decide when a step of the loop is due, and which time the loop, a state and a reference have.
All times are ns, unless stated otherwise.
"""

from abc import abstractmethod
from collections.abc import Callable
from enum import Enum, auto
from typing import ClassVar, NamedTuple, Protocol

from pam_ros.timing.delay import Lateness
from pam_ros.timing.interruption import Interruptions, steady_ns
from pam_ros.timing.pace import SECOND
from pam_ros.timing.pacing import Pacing, Reply

# s; if a step is later than this, messages that arrived meanwhile are received first.
LATE = 0.05
WATCH_RATE = 20.0  # Hz at which timeouts are checked if time follows the states
# ns of interruption after which only the newest state is answered, if time follows the states: a
# scaled simulation has continued meanwhile; one in lockstep has waited, and no state is lost.
LONG = SECOND // 2


class LoopSettings(Protocol):
    """The settings of a loop that its pacing needs."""

    @property
    def rate(self) -> float:
        """Rate of the commands in Hz."""

    @property
    def state_timeout(self) -> float:
        """Age in s above which a state is too old."""

    @property
    def longest_interruption(self) -> float:
        """Duration in s of an interruption after which control starts again."""


class Step(NamedTuple):
    """A step of the loop: its time in s by the clock of the loop, and its ROS time in ns."""

    time: float
    stamp: int


class Arrival(NamedTuple):
    """What the arrival of a state means for the loop."""

    time: int  # of the state by the clock of the loop
    received: int  # steady time from which the age of the state counts
    reply: Reply
    late: int = 0  # by how much it arrived late
    is_repeated: bool = False  # it has the stamp of the state before
    is_earlier: bool = False  # the time that it follows has started again
    pause: int = 0  # since the state before, if that is so long that control starts again


class Use(Enum):
    """When a measurement is used."""

    NOW = auto()
    LATER = auto()  # after an interruption, if it is then the newest one
    NEVER = auto()


class LoopPacing(Pacing):
    """When the steps of a loop are due; it knows the newest state and finds interruptions.

    With ``confirms_commands`` a rig acknowledges a command soon after it was sent.
    """

    confirms_commands: ClassVar[bool]

    def __init__(
        self,
        settings: LoopSettings,
        ros: Callable[[], int],
        steady: Callable[[], int] = steady_ns,
    ) -> None:
        """Begin without a state; *ros* returns the ROS time."""
        super().__init__(steady)
        self._settings, self._ros = settings, ros
        self._stamp: int | None = None
        # Steady times of the newest usable state, and of the last one whose stamp was not new.
        self._seen = self._repeated = steady()
        self._interruptions = Interruptions(self._seen)

    def change(self, settings: LoopSettings) -> None:
        """Continue with other settings."""
        self._settings = settings

    # States --------------------------------------------------------------------------------

    @property
    def stamp(self) -> int | None:
        """Stamp of the newest state, 0 if it has none; None before a first state."""
        return self._stamp

    @property
    def age(self) -> float | None:
        """Steady time in s since the newest usable state, None before a first state."""
        return None if self._stamp is None else (self._steady() - self._seen) / SECOND

    @property
    def repeated_stamp(self) -> int | None:
        """The stamp of the states if they repeat it for too long, else None.

        A stamp may repeat for a while: in lockstep a state is sent again until it is answered,
        and a rig that publishes faster than it measures repeats each state, also the one with
        which it stops.
        """
        lasts = self._repeated - self._seen > 0.5 * self._settings.state_timeout * SECOND
        return self._stamp if lasts and not self.is_fresh() else None

    def arrive(self, stamp: int) -> Arrival:
        """Note that a state arrives now; *stamp* is 0 if it has none."""
        now = self._steady()
        if stamp and stamp == self._stamp:
            self._repeated = now
            reply = self.reply_to_state(is_repeated=True)
            return Arrival(now, now, reply, is_repeated=True)
        arrival = self._arrival(stamp, now)
        self._stamp = stamp
        return arrival

    @abstractmethod
    def _arrival(self, stamp: int, now: int) -> Arrival:
        """Return what a state with a new *stamp* means that arrives at the steady time *now*."""

    def use(self, arrival: Arrival) -> None:
        """Note that the state that has arrived is usable."""
        self._seen = arrival.received

    def forget(self) -> None:
        """Forget the newest state."""
        self._stamp = None

    def is_fresh(self) -> bool:
        """Return whether the newest usable state is not older than the timeout."""
        return self._age() <= self._settings.state_timeout * SECOND

    def _age(self) -> int:
        return self._steady() - self._seen

    # Steps ---------------------------------------------------------------------------------

    @property
    @abstractmethod
    def tick_rate(self) -> float:
        """Rate in Hz at which the program looks for what is due."""

    @property
    @abstractmethod
    def wanted_rate(self) -> float | None:
        """Rate of the commands in Hz, None if the states set it."""

    @abstractmethod
    def receives_first(self, now: int) -> bool:
        """Return whether the tick at *now* is so late that waiting messages come first."""

    @abstractmethod
    def due(self, now: int, *, is_waiting: bool) -> Step | None:
        """Return the step that is due at the tick at *now*, None if there is none.

        *is_waiting* means that the loop has not begun, or has lost the states.
        """

    @abstractmethod
    def answer(self) -> Step | None:
        """Return the step that answers the newest state, None if a state is not to be answered."""

    @abstractmethod
    def wait_until(self, stamp: int, last: float) -> float:
        """Return the time in s to the ROS time *stamp* from *last*.

        *last* is the time in s of the last step of the loop.
        """

    # Interruptions -------------------------------------------------------------------------

    def mark(self, now: int) -> None:
        """Note that the work that began at the steady time *now* is done."""
        self._interruptions.mark(now)

    @property
    def is_settling(self) -> bool:
        """Whether messages that were queued during an interruption may still arrive."""
        return self._interruptions.is_settling

    @abstractmethod
    def interruption(self) -> int:
        """Look for an interruption of this process until now.

        Return its duration if control starts again after it, else 0.
        """

    @abstractmethod
    def use_of(self, source: str, stamp: int) -> Use:
        """Return when to use a measurement of *source* that arrives now; *stamp* 0: none."""


class OwnRate(LoopPacing):
    """The loop has a rate of its own on the wall clock, whose time the states get as well."""

    answers_states = False
    confirms_commands = True

    def __init__(
        self,
        settings: LoopSettings,
        ros: Callable[[], int],
        steady: Callable[[], int] = steady_ns,
    ) -> None:
        """Begin without a state; *ros* returns the ROS time."""
        super().__init__(settings, ros, steady)
        self._lateness = Lateness()
        self._ticked = self._seen  # steady time of the last tick
        self._has_received = False  # whether that tick received messages first

    @property
    def tick_rate(self) -> float:
        """Rate of the commands in Hz."""
        return self._settings.rate

    @property
    def wanted_rate(self) -> float | None:
        """Rate of the commands in Hz."""
        return self._settings.rate

    def _arrival(self, stamp: int, now: int) -> Arrival:
        late = self._lateness.of(stamp, now)
        # This is the time of the loop: what is too old for the loop must be too old here, too.
        time = now - late
        return Arrival(time, time, self.reply_to_state(is_repeated=False), late)

    def receives_first(self, now: int) -> bool:
        """Return whether the tick at *now* is late, and the one before was not."""
        settings = self._settings
        longest = max(min(0.5 * settings.state_timeout, LATE), 3.0 / settings.rate) * SECOND
        is_late = now - self._ticked > longest and not self._has_received
        self._ticked, self._has_received = now, is_late
        return is_late

    def due(self, now: int, *, is_waiting: bool) -> Step:
        """Return the step of *now*: one is due at each tick."""
        return Step(now / SECOND, self._ros())

    def answer(self) -> None:
        """Return None: a state waits for the next tick."""

    def wait_until(self, stamp: int, last: float) -> float:
        """Return the time in s to the ROS time *stamp* from *last*, a steady time in s."""
        since = self._steady() / SECOND - last
        return (stamp - self._ros()) / SECOND + since

    def interruption(self) -> int:
        """Return an interruption that was longer than the rig keeps the last command, else 0."""
        longest = round(self._settings.longest_interruption * SECOND)
        return self._interruptions.find(self._steady(), longest)

    def use_of(self, source: str, stamp: int) -> Use:
        """Return NEVER for a measurement from before the end of an interruption."""
        is_old = self._interruptions.is_old(source, stamp, self._steady())
        return Use.NEVER if is_old else Use.NOW


class OneStepPerState(LoopPacing):
    """The loop has the time of the states, and answers each new one with one step."""

    answers_states = True
    confirms_commands = False  # so many commands are kept that they are confirmed too late

    @property
    def tick_rate(self) -> float:
        """Rate in Hz at which timeouts are checked."""
        return WATCH_RATE

    @property
    def wanted_rate(self) -> None:
        """None: the states set the rate."""

    def _arrival(self, stamp: int, now: int) -> Arrival:
        passed = 0 if self._stamp is None else stamp - self._stamp
        is_long = passed > self._settings.longest_interruption * SECOND
        return Arrival(
            stamp,
            now,
            self.reply_to_state(is_repeated=False),
            is_earlier=passed < 0,
            pause=passed if is_long else 0,
        )

    def _age(self) -> int:
        age = super()._age()
        if self._stamp is None:
            return age
        # The smaller of two ages: /clock may arrive before the states that belong to it.
        return min(age, self._ros() - self._stamp)

    def receives_first(self, now: int) -> bool:
        """Return False: a tick only checks whether the states stop."""
        return False

    def due(self, now: int, *, is_waiting: bool) -> Step | None:
        """Return the step of the present ROS time if the states have stopped.

        A loop that waits answers the newest state.
        """
        if self._stamp is None:
            return None
        if self.is_fresh():
            return self.answer() if is_waiting else None
        ros = self._ros()
        return Step(ros / SECOND, ros)

    def answer(self) -> Step | None:
        """Return the step at the time of the newest state, None before a first one."""
        return None if self._stamp is None else Step(self._stamp / SECOND, self._stamp)

    def wait_until(self, stamp: int, last: float) -> float:
        """Return the time in s to the ROS time *stamp* from the newest state, the last step."""
        assert self._stamp is not None, 'the loop steps when it receives a state'
        return (stamp - self._stamp) / SECOND

    def interruption(self) -> int:
        """Return 0: the simulated time between two states shows an interruption."""
        self._interruptions.find(self._steady(), LONG)
        return 0

    def use_of(self, source: str, stamp: int) -> Use:
        """Return LATER while messages from an interruption may still arrive, then NOW."""
        return Use.LATER if self.is_settling else Use.NOW


def loop_pacing(
    settings: LoopSettings, ros: Callable[[], int], *, is_simulated: bool
) -> LoopPacing:
    """Return the pacing of a loop whose ROS time is *ros*(), *is_simulated* by the rig or not."""
    return (OneStepPerState if is_simulated else OwnRate)(settings, ros)
