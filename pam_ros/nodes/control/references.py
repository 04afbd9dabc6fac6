# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics on which a controller receives its reference: targets, trajectories, co-contraction.

They are refused, with a message in the log, while the loop does not control.
"""

from collections.abc import Callable

from std_msgs.msg import Float64
from trajectory_msgs.msg import JointTrajectory

from pam_ros.control.loop import RUNNING, Loop
from pam_ros.control.reference.points import Points
from pam_ros.control.reference.serialised import read_trajectory
from pam_ros.control.reference.trajectory import ReferenceTrajectory
from pam_ros.errors import RangeError
from pam_ros.health.loop_health import LoopHealth
from pam_ros.health.reports import Reports
from pam_ros.nodes.control.intake import StateIntake
from pam_ros.settings.control import ControlSetup
from pam_ros.timing.loop_pacing import LoopPacing


class ReferenceInput:
    """Passes references on to a loop, and says why it refuses one."""

    def __init__(
        self,
        loop: Loop,
        setup: Callable[[], ControlSetup],
        pacing: LoopPacing,
        health: LoopHealth,
        reports: Reports,
    ) -> None:
        """Serve *loop*, which has the settings of *setup*() and the *pacing*.

        *health* says why the loop does not control; refusals go to *reports*.
        """
        self._loop, self._setup, self._pacing = loop, setup, pacing
        self._health, self._reports = health, reports

    def subscribe(self, intake: StateIntake) -> None:
        """Subscribe to the topics by *intake*."""
        intake.subscribe(Float64, 'position_reference', self._take_position)
        # Raw: converting its points to Python objects would delay commands for too long.
        intake.subscribe(JointTrajectory, 'joint_trajectory', self._take_trajectory, raw=True)
        if self._setup().law.can_stiffen:
            intake.subscribe(Float64, 'co_contraction_reference', self._take_co_contraction)

    def _take_position(self, message: Float64) -> None:
        self._set('position_reference', lambda: self._loop.source.set_target(message.data))

    def _take_co_contraction(self, message: Float64) -> None:
        self._set('co_contraction_reference', lambda: self._loop.law.stiffen(message.data))

    def _take_trajectory(self, message: bytes) -> None:
        self._set('joint_trajectory', lambda: self._play_or_stop(message))

    def _set(self, topic: str, change: Callable[[], object]) -> None:
        """Change the reference as a message on *topic* demands, or say why it is refused."""
        if self._loop.state != RUNNING:
            self._reports.refuse(f'{topic} is ignored: {self._health.trouble()}')
            return
        try:
            change()
        except RangeError as error:
            self._reports.refuse(str(error))

    def _play_or_stop(self, message: bytes) -> None:
        """Follow a trajectory; one without points stops the present one."""
        begin, points = read_trajectory(message, self._setup().settings.joint_name)
        if points.count:
            self._play(begin, points)
        else:
            self._loop.source.stop()

    def _play(self, begin: int, points: Points) -> tuple[ReferenceTrajectory, float]:
        """Follow *points* from the ROS time *begin* in ns, 0 for now; also return when, in s."""
        wait = self._wait_until(begin) if begin else 0.0
        return self._loop.source.play(points, wait), self._loop.time + wait

    def play_goal(self, message: bytes) -> tuple[ReferenceTrajectory, float]:
        """Follow the serialised JointTrajectory of a goal; return it with its time of start in s.

        Raises RangeError if it is over already, or not valid.
        """
        begin, points = read_trajectory(message, self._setup().settings.joint_name)
        points.refuse_bad()
        over = -self._wait_until(begin) - points.times[-1] if begin else 0.0
        if over > 0.0:
            raise RangeError(f'the trajectory ended {over:.4g} s ago')
        return self._play(begin, points)

    def _wait_until(self, begin: int) -> float:
        """Return the time in s from the last step of the loop to the ROS time *begin* in ns."""
        return self._pacing.wait_until(begin, self._loop.time)
