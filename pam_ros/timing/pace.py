# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How much simulated time is due, and the stamp of each simulated step."""

SECOND = 1_000_000_000
CATCH_UP = SECOND // 2  # longest delay that is caught up, ns
JUMP = SECOND // 10  # ns by which slewing may move ROS time against steady time; more is a jump


class Pace:
    """Lets simulated steps follow ROS time, one step per period of the physics rate.

    Step k has the stamp ``origin + k / rate``, so that stamps are exactly as far apart as the
    states that they belong to. The origin moves only if the simulation must not follow: while it
    is paused, when the clock jumps (which is found by comparison with the steady clock), and when
    more than CATCH_UP has been missed. All times are ns.
    """

    def __init__(self, rate: float, ros: int, steady: int) -> None:
        """Start at step 0 at the times *ros* and *steady*, with *rate* in Hz."""
        self.rate = rate
        self.jumps = 0
        self.lost = 0.0  # simulated seconds of delay that are not caught up
        self.origin = ros
        self._ros, self._steady = ros, steady

    def stamp(self, step: int) -> int:
        """Return the ROS time of a step."""
        return self.origin + round(step * SECOND / self.rate)

    def steady_time(self, step: int) -> int:
        """Return the steady time at which a step will be due."""
        return self._steady + self.stamp(step) - self._ros

    def align(self, step: int, ros: int, steady: int) -> None:
        """Let *step* be due now, regardless of the time that has passed."""
        self.origin = ros - round(step * SECOND / self.rate)
        self._ros, self._steady = ros, steady

    def due(self, step: int, ros: int, steady: int, is_simulated: bool, ahead: float = 0.0) -> int:
        """Return the step that is due now, if the simulation is at *step*.

        Steps that are due within the next *ahead* steps count as due, too: 0.5 gives the nearest
        step.

        *is_simulated* means that ROS time comes from ``/clock``. Then it may run at any speed, and
        a jump is only a step backwards, or one forwards by more than 2 CATCH_UP.
        """
        leap = passed = ros - self._ros
        if is_simulated:
            is_jump = not 0 <= passed <= 2 * CATCH_UP
        else:
            leap -= steady - self._steady
            is_jump = abs(leap) > JUMP
        self._ros, self._steady = ros, steady
        if is_jump:
            self.origin += leap
            self.jumps += 1
        behind = ros - self.stamp(step)
        if behind > CATCH_UP:
            self.lost += (behind - CATCH_UP) / SECOND
            self.origin += behind - CATCH_UP
        return max(step, int((ros - self.origin) * self.rate + ahead * SECOND) // SECOND)
