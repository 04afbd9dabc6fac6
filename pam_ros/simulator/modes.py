# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The three time modes of the simulator: which steps are due, and the ROS time of each step."""

import math
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable
from time import monotonic_ns, time_ns
from typing import Any, ClassVar, Protocol

from pam_ros.settings.scene import SimulationSetup
from pam_ros.settings.sim import SimSettings
from pam_ros.simulator.turns import Turns
from pam_ros.timing.pace import CATCH_UP, SECOND, Pace

FIRST = SECOND  # ROS time at the first step of the simulator's own time: 0 would mean no time
SLICE = 5_000_000  # ns of simulation after which commands and services are handled
GAP = 200_000  # ns for them when simulated time passes as fast as possible
IDLE_RATE = 10.0  # Hz at which a simulator whose time stands still publishes its state
FASTEST_TICK = 1000.0  # Hz


class RosClock(Protocol):
    """The part of rclpy's clock that gives the ROS time."""

    @property
    def ros_time_is_active(self) -> bool:
        """Whether the time comes from ``/clock``."""

    def now(self) -> Any:
        """Return the time, with ``nanoseconds``."""


class Mode(ABC):
    """How simulated time passes. Times are ns, *step* is the step that the simulation has reached.

    With ``makes_time`` the simulator makes the ROS time and publishes it on ``/clock``; otherwise
    it follows ROS time. ``turns`` are the commands for which time waits, None if it does not wait.
    ``slice`` is the longest time in ns that the simulation may take before commands are
    handled.
    """

    makes_time: ClassVar[bool] = True
    turns: Turns | None = None
    slice: ClassVar[float] = math.inf

    def __init__(self, settings: SimSettings, steady: Callable[[], int] = monotonic_ns) -> None:
        """Start at step 0 now; *steady* returns the time of a clock that never jumps."""
        self._settings, self._steady = settings, steady

    @property
    @abstractmethod
    def speed(self) -> float:
        """Desired simulated seconds per second; 0: no pace is set."""

    @property
    def follows_clock(self) -> bool:
        """Whether ROS time comes from the ``/clock`` of another node."""
        return False

    @property
    def jumps(self) -> int:
        """How often the ROS time that it follows has jumped."""
        return 0

    @property
    def lost(self) -> float:
        """Simulated seconds of delay that are not caught up."""
        return 0.0

    @abstractmethod
    def now(self) -> int:
        """Return the ROS time: of the last step that was stamped if the simulator makes it."""

    @abstractmethod
    def stamp(self, step: int) -> int:
        """Return the ROS time of a step that the simulation has reached."""

    @abstractmethod
    def due(self, step: int, sample: int, ahead: float = 0.0) -> int:
        """Return the step until which to simulate now, including *ahead* steps of the future.

        *sample* is the step of the next sample.
        """

    @abstractmethod
    def align(self, step: int) -> None:
        """Let *step* be due now, regardless of the time that has passed."""

    @abstractmethod
    def restart(self, step: int) -> None:
        """Start again at step 0."""

    @abstractmethod
    def tick_rate(self, *, is_paused: bool) -> float:
        """Return the rate in Hz at which the simulator looks for what is due."""

    def wakes(self, step: int) -> int | None:
        """Return the steady time at which to look for *step*; None: at the next tick."""
        return None

    def change(self, settings: SimSettings, step: int) -> None:
        """Continue with other settings."""
        self._settings = settings


class RealTime(Mode):
    """ROS time is followed: the system's, or that of another node's ``/clock``."""

    makes_time = False
    speed = 1.0

    def __init__(
        self,
        settings: SimSettings,
        clock: RosClock,
        steady: Callable[[], int] = monotonic_ns,
    ) -> None:
        """Follow *clock*; step 0 is due now."""
        super().__init__(settings, steady)
        self._clock = clock
        self._pace = Pace(settings.physics_rate, self.now(), steady())

    @property
    def follows_clock(self) -> bool:
        """Whether ROS time comes from ``/clock``."""
        return self._clock.ros_time_is_active

    @property
    def jumps(self) -> int:
        """How often ROS time has jumped."""
        return self._pace.jumps

    @property
    def lost(self) -> float:
        """Simulated seconds of delay that are not caught up."""
        return self._pace.lost

    def now(self) -> int:
        """Return the ROS time."""
        # Otherwise it is the system's time, which takes less time to read directly.
        return self._clock.now().nanoseconds if self._clock.ros_time_is_active else time_ns()

    def stamp(self, step: int) -> int:
        """Return the ROS time of a step."""
        return self._pace.stamp(step)

    def due(self, step: int, sample: int, ahead: float = 0.0) -> int:
        """Return the step that is due in *ahead* steps."""
        return self._pace.due(step, self.now(), self._steady(), self.follows_clock, ahead)

    def align(self, step: int) -> None:
        """Let *step* be due now, regardless of the time that has passed."""
        self._pace.align(step, self.now(), self._steady())

    def restart(self, step: int) -> None:
        """Start again at step 0 now."""
        self.align(0)

    def tick_rate(self, *, is_paused: bool) -> float:
        """Return the rate of publication, also while paused: time does not stand still."""
        return self._settings.publish_rate

    def wakes(self, step: int) -> int | None:
        """Return when *step* is due: resets and jumps of ROS time move it."""
        return None if self.follows_clock else self._pace.steady_time(step)


class OwnTime(Mode):
    """The simulator makes the time.

    It never goes back, even at a reset, so that no program that follows it sees a jump.
    """

    def __init__(self, settings: SimSettings, steady: Callable[[], int] = monotonic_ns) -> None:
        """Start at step 0 now."""
        super().__init__(settings, steady)
        self._origin = self._last = FIRST
        self.align(0)

    def now(self) -> int:
        """Return the time of the last step that was stamped."""
        return self._last

    def stamp(self, step: int) -> int:
        """Return the time of a step that the simulation has reached."""
        self._last = self._origin + round(step * SECOND / self._settings.physics_rate)
        return self._last

    def restart(self, step: int) -> None:
        """Start again at step 0, one period after *step*."""
        self._origin = self.stamp(step) + round(SECOND / self._settings.publish_rate)
        self.align(0)


class Scaled(OwnTime):
    """Time passes ``speed_factor`` times as fast as the steady clock; 0: as fast as possible."""

    slice = SLICE

    def __init__(self, settings: SimSettings, steady: Callable[[], int] = monotonic_ns) -> None:
        """Start at step 0 now."""
        super().__init__(settings, steady)
        self._lost = 0.0

    @property
    def lost(self) -> float:
        """Simulated seconds of delay that are not caught up."""
        return self._lost

    @property
    def speed(self) -> float:
        """Simulated seconds per second; 0: as many as possible."""
        return self._settings.speed_factor

    def due(self, step: int, sample: int, ahead: float = 0.0) -> int:
        """Return the step that is due in *ahead* steps; without a pace all are due."""
        if not self.speed:
            return sys.maxsize
        now, rate = self._steady(), self.speed * self._settings.physics_rate
        behind = now - self._due_at(step)
        if behind > CATCH_UP:
            self._lost += (behind - CATCH_UP) * self.speed / SECOND
            self._first, self._first_at = step, now - CATCH_UP
        passed = (now - self._first_at) * rate
        return max(step, self._first + int(passed / SECOND + ahead))

    def align(self, step: int) -> None:
        """Let *step* be due now, regardless of the time that has passed."""
        self._first, self._first_at = step, self._steady()

    def change(self, settings: SimSettings, step: int) -> None:
        """Continue with other settings; another speed begins at *step*."""
        is_other = settings.speed_factor != self.speed
        super().change(settings, step)
        if is_other:
            self.align(step)

    def tick_rate(self, *, is_paused: bool) -> float:
        """Return the rate at which messages are due."""
        if is_paused:
            return IDLE_RATE
        settings = self._settings
        rate = max(settings.publish_rate, settings.clock_rate) * self.speed
        return min(rate, FASTEST_TICK) if rate else FASTEST_TICK

    def wakes(self, step: int) -> int | None:
        """Return when *step* is due; without a pace soon."""
        return self._due_at(step) if self.speed else self._steady() + GAP

    def _due_at(self, step: int) -> int:
        rate = self.speed * self._settings.physics_rate
        return self._first_at + round((step - self._first) * SECOND / rate)


class Lockstep(OwnTime):
    """One period of ``publish_rate`` for each command: time waits for the controllers."""

    turns: Turns
    speed = 0.0

    def __init__(
        self, settings: SimSettings, turns: Turns, steady: Callable[[], int] = monotonic_ns
    ) -> None:
        """Wait for the commands that *turns* counts."""
        self.turns = turns
        super().__init__(settings, steady)

    def due(self, step: int, sample: int, ahead: float = 0.0) -> int:
        """Return the step of the next sample when all muscles were commanded, else *step*."""
        return sample if self.turns.is_complete else step

    def align(self, step: int) -> None:
        """Expect more than one command for the present state, see :class:`Turns`."""
        self.turns.settle()

    def tick_rate(self, *, is_paused: bool) -> float:
        """Return a slow rate, at which a state is repeated: commands set the pace."""
        return IDLE_RATE


def mode_of(
    setup: SimulationSetup, publishers: Callable[[], frozenset[bytes]], clock: RosClock
) -> Mode:
    """Return the mode of ``time_mode``. In lockstep *publishers* are watched, see :class:`Turns`.

    In real time the ROS time is that of *clock*.
    """
    settings = setup.settings
    if settings.time_mode == 'lockstep':
        return Lockstep(settings, Turns(len(setup.muscles), publishers))
    if settings.time_mode == 'scaled':
        return Scaled(settings)
    return RealTime(settings, clock)
