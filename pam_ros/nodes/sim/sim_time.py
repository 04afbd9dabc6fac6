# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The time of the simulator: ROS time that it follows, or time that it makes itself."""

import sys
from time import monotonic_ns, time_ns

from rclpy.clock import Clock

from pam_ros.timing.pace import CATCH_UP, SECOND, Pace

FIRST = SECOND  # ROS time at the first step of the simulator's own time: 0 would mean no time


class FollowedTime:
    """ROS time: the system's, or that of another node's ``/clock``."""

    def __init__(self, rate: float, clock: Clock) -> None:
        """Start at step 0 now, with *rate* steps per second."""
        self._clock = clock
        self._pace = Pace(rate, self.now(), monotonic_ns())

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
        """Return the ROS time in ns."""
        # Otherwise it is the system's time, which takes less time to read directly.
        return self._clock.now().nanoseconds if self._clock.ros_time_is_active else time_ns()

    def stamp(self, step: int) -> int:
        """Return the ROS time of a step."""
        return self._pace.stamp(step)

    def steady_time(self, step: int) -> int:
        """Return the steady time at which a step will be due."""
        return self._pace.steady_time(step)

    def due(self, step: int, ahead: float = 0.0) -> int:
        """Return the step that is due in *ahead* steps, if the simulation is at *step*."""
        return self._pace.due(step, self.now(), monotonic_ns(), self.follows_clock, ahead)

    def align(self, step: int) -> None:
        """Let *step* be due now, regardless of the time that has passed."""
        self._pace.align(step, self.now(), monotonic_ns())

    def restart(self, step: int, gap: int) -> None:
        """Start again at step 0 now."""
        self.align(0)


class OwnTime:
    """Time that the simulator makes itself, ``factor`` times as fast as the steady clock.

    With a factor of 0 no pace is set: all steps are due. Time never goes back, even at a reset, so
    that no program that follows it sees a jump.
    """

    follows_clock = False
    jumps = 0

    def __init__(self, rate: float, factor: float) -> None:
        """Start at step 0 now, with *rate* steps per simulated second."""
        self._rate, self.factor = rate, factor
        self._origin, self.lost = FIRST, 0.0
        self._last = FIRST
        self.align(0)

    def now(self) -> int:
        """Return the time of the last step that was stamped, in ns."""
        return self._last

    def stamp(self, step: int) -> int:
        """Return the time of a step that the simulation has reached."""
        self._last = self._origin + round(step * SECOND / self._rate)
        return self._last

    def steady_time(self, step: int) -> int:
        """Return the steady time at which a step will be due."""
        if not self.factor:
            return monotonic_ns()
        return self._steady + round((step - self._step) * SECOND / (self.factor * self._rate))

    def due(self, step: int, ahead: float = 0.0) -> int:
        """Return the step that is due in *ahead* steps, if the simulation is at *step*."""
        if not self.factor:
            return sys.maxsize
        now = monotonic_ns()
        behind = now - self.steady_time(step)
        if behind > CATCH_UP:
            self.lost += (behind - CATCH_UP) * self.factor / SECOND
            self._step, self._steady = step, now - CATCH_UP
        passed = (now - self._steady) * self.factor * self._rate
        return max(step, self._step + int(passed / SECOND + ahead))

    def align(self, step: int) -> None:
        """Let *step* be due now, regardless of the time that has passed."""
        self._step, self._steady = step, monotonic_ns()

    def restart(self, step: int, gap: int) -> None:
        """Start again at step 0 now, *gap* ns after *step*, which the simulation had reached."""
        self._origin = self.stamp(step) + gap
        self.align(0)
