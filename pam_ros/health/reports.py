# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Reports of a controller on received messages, in its log and in its diagnostics."""

from typing import Any

from pam_ros.control.loop import LATE
from pam_ros.health.absence import Absence
from pam_ros.health.controller import Received
from pam_ros.health.health import Level
from pam_ros.timing.pace import SECOND

OFTEN = 0.1  # share of the joint states; single ones are late on every computer
DELAYED = (
    '{} of {} joint_states were late according to their stamps, by up to {:.2f} s: control '
    'continued with the model meanwhile. Usual causes are a busy computer or network, or a rig '
    'whose clock runs slower (set use_sim_time then)'
)


class Reports:
    """Counts the faults of received messages, and writes them to a log."""

    def __init__(self, logger: Any) -> None:
        """Write to *logger*, of rclpy."""
        self._logger = logger
        self._refusal, self._refused, self._is_refusal_new = '', 0, False
        self._implausibility, self._is_implausibility_new = '', False
        self._pause, self._pauses, self._is_pause_new = '', 0, False
        self._tracking = ''
        self._late = 0
        self._seen = self._newly_late = 0  # since the last report
        self._latest = 0.0
        self._start = Absence(logger, 'control begins')
        self._states = Absence(
            logger, 'joint_states are received again: control continues', 0.0, Level.ERROR
        )

    def refuse(self, reason: str) -> None:
        """Report why a reference or a trajectory is refused."""
        self._count_refusal(reason)
        self._logger.warning(reason, throttle_duration_sec=1.0)

    def reject(self, reason: str) -> None:
        """Report why a goal of the action or the active reference is rejected.

        Each one is logged, for they are few.
        """
        self._count_refusal(reason)
        self._logger.warning(reason)

    def _count_refusal(self, reason: str) -> None:
        self._refusal, self._is_refusal_new = reason, True
        self._refused += 1

    def leave_out(self, what: str) -> None:
        """Report that a measurement cannot be true and is not used."""
        self._implausibility, self._is_implausibility_new = what, True
        self._logger.warning(what, throttle_duration_sec=1.0)

    def restart(self, pause: int, limit: str) -> None:
        """Report that control starts again, after *pause* ns without a command.

        *limit* describes the limit that was exceeded.
        """
        self._pause = (
            f'no command was given for {pause / SECOND:.2f} s, longer than {limit}: '
            'control starts again from the present position'
        )
        self._is_pause_new = True
        self._pauses += 1
        self._logger.warning(self._pause)

    def delay(self, late: float) -> None:
        """Note that a joint state arrived *late* s late."""
        self._seen += 1
        if late > LATE:
            self._late += 1
            self._newly_late += 1
        self._latest = max(self._latest, late)

    def follow(self, tracking: str) -> None:
        """Report which error or saturation lasts, '' if none does; log it when it begins."""
        if tracking and not self._tracking:
            self._logger.warning(tracking)
        self._tracking = tracking

    def wait(self, why: str, now: float) -> None:
        """Report once why control has not begun yet, '' if it has begun; *now* in s."""
        self._start.look(why, now)

    def miss(self, why: str, now: float, timeout: float, starts: int) -> None:
        """Report once why control has stopped, '' if it continues.

        It counts as continued after it has done so for *timeout* s without a change of *starts*,
        the count of its starts.
        """
        self._states.look(why, now, timeout, starts)

    def received(self, age: float | None, blindness: str) -> Received:
        """Return the current report; what is new in it is no longer new in the next one."""
        is_often_late = self._newly_late > OFTEN * self._seen
        delay = DELAYED.format(self._newly_late, self._seen, self._latest)
        received = Received(
            age=age,
            blindness=blindness,
            refused=self._refused,
            refusal=self._refusal,
            is_refusal_new=self._is_refusal_new,
            implausibility=self._implausibility,
            is_implausibility_new=self._is_implausibility_new,
            pauses=self._pauses,
            pause=self._pause,
            is_pause_new=self._is_pause_new,
            late=self._late,
            delay=delay if is_often_late else '',
            tracking=self._tracking,
        )
        self._seen = self._newly_late = 0
        self._latest = 0.0
        self._is_refusal_new = self._is_implausibility_new = self._is_pause_new = False
        return received
