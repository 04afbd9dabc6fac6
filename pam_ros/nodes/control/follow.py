# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The action ``~/follow_joint_trajectory``: a trajectory with feedback, tolerances and a result.

It needs the package control_msgs. Without it there is no action.
"""

from collections.abc import Callable, Collection
from importlib import import_module
from typing import Any, NamedTuple

from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from rclpy.task import Future
from trajectory_msgs.msg import JointTrajectoryPoint

from pam_ros.control.goal import Goal, Outcome, Tolerance, Tolerances
from pam_ros.control.loop import RUNNING, Loop
from pam_ros.control.reference.source import ReferenceSource
from pam_ros.control.reference.trajectory import ReferenceTrajectory
from pam_ros.control.signals import Reference
from pam_ros.errors import RangeError
from pam_ros.settings.control import ControlSetup
from pam_ros.timing.pace import SECOND

NAME = 'follow_joint_trajectory'
FEEDBACK = 0.05  # s between two messages of feedback, as in the joint_trajectory_controller
KEPT = 1000  # messages of feedback for a client that is late: in lockstep they come fast

try:
    FollowJointTrajectory: Any = import_module('control_msgs.action').FollowJointTrajectory
except ImportError:
    FollowJointTrajectory = None


class Active(NamedTuple):
    """A goal that is followed: it counts until another target is set after its own."""

    goal: Goal
    source: ReferenceSource
    target: int
    goal_handle: ServerGoalHandle
    done: Future  # of a function that ends the goal and returns its result


class Follow:
    """Serves the action for a loop, if the package of its messages is installed."""

    def __init__(
        self,
        node: Node,
        loop: Loop,
        setup: Callable[[], ControlSetup],
        play: Callable[[bytes], tuple[ReferenceTrajectory, float]],
        trouble: Callable[[], str],
        refuse: Callable[[str], None],
    ) -> None:
        """Serve it on *node* for *loop*, which has the settings of *setup*().

        *play*(message) lets the loop follow a serialised JointTrajectory and returns it with the
        time in s at which it begins, or raises RangeError. *trouble*() says why the loop does not
        control. *refuse*(sentence) reports a goal that is not accepted.
        """
        self._node, self._loop, self._setup = node, loop, setup
        self._play, self._trouble, self._refuse = play, trouble, refuse
        self._next: Goal | None = None
        self._active: Active | None = None
        self._shown = 0.0  # time of the last feedback, s
        self._server: ActionServer | None = None
        if FollowJointTrajectory is not None:
            self._server = ActionServer(
                node,
                FollowJointTrajectory,
                f'~/{NAME}',
                execute_callback=_never,
                goal_callback=self._consider,
                handle_accepted_callback=self._accept,
                cancel_callback=lambda handle: CancelResponse.ACCEPT,
                feedback_pub_qos_profile=QoSProfile(depth=KEPT),
            )

    def close(self) -> None:
        """Offer the action no longer."""
        if self._server is not None:
            self._server.destroy()

    # Goals -----------------------------------------------------------------------------------

    def _consider(self, request: Any) -> GoalResponse:
        """Begin to follow a goal, or reject it with a message in the log."""
        try:
            self._next = self._begun(request)
        except RangeError as error:
            self._refuse(f'{NAME}: {error}')
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def _begun(self, request: Any) -> Goal:
        if self._loop.state != RUNNING:
            raise RangeError(self._trouble())
        several = (
            request.multi_dof_trajectory.points,
            request.component_path_tolerance,
            request.component_goal_tolerance,
        )
        if any(several):
            raise RangeError('multi_dof_trajectory and its tolerances are not for a single joint')
        time, others = request.goal_time_tolerance, request.trajectory.joint_names
        asked = Tolerances(
            self._tolerance(request.path_tolerance, others),
            self._tolerance(request.goal_tolerance, others),
            time.sec + time.nanosec / SECOND,
        )
        # Last, since the joint begins to move.
        trajectory, start = self._play(serialize_message(request.trajectory))
        return Goal(trajectory, start, self._setup().law.unit, asked)

    def _tolerance(self, given: Any, others: Collection[str]) -> Tolerance:
        """Return the tolerance of the joint among those that are *given* for it and *others*."""
        found, joint = Tolerance(), self._setup().settings.joint_name
        for one in given:
            if one.name != joint:
                if one.name in others:
                    continue
                raise RangeError(
                    f'a tolerance is for joint {one.name!r}, not {joint} (joint_name)'
                )
            if one.velocity > 0.0 and not self._has_velocity:
                raise RangeError(
                    f'a tolerance of the velocity of {one.velocity:g} is not allowed, since '
                    'controller = pid does not estimate the velocity: give 0 for none'
                )
            if one.acceleration > 0.0:
                raise RangeError(
                    f'a tolerance of the acceleration of {one.acceleration:g} is not allowed, '
                    'since the acceleration is not measured: give 0 for none'
                )
            found = Tolerance(one.position, one.velocity)
        return found

    @property
    def _has_velocity(self) -> bool:
        """Whether the law estimates the velocity of the joint."""
        return self._setup().settings.controller != 'pid'

    def _accept(self, handle: ServerGoalHandle) -> None:
        assert self._next is not None
        self._end('abort', 'INVALID_GOAL', 'replaced by another goal')
        source, done = self._loop.source, Future()
        self._active = Active(self._next, source, source.targets, handle, done)
        self._shown = self._loop.time

        async def result(_: ServerGoalHandle) -> Any:
            finish = await done
            return finish()

        handle.execute(result)

    def _end(self, how: str, code: str, text: str) -> None:
        """End the active goal, if there is one: *how* is the name of the handle's function."""
        if self._active is None:
            return
        handle, done = self._active.goal_handle, self._active.done
        self._active = None

        def finish() -> Any:
            getattr(handle, how)()
            result = FollowJointTrajectory.Result(error_string=text)
            result.error_code = getattr(FollowJointTrajectory.Result, code)
            return result

        done.set_result(finish)

    # After each step of the loop ---------------------------------------------------------------

    def update(self) -> None:
        """End the active goal if it is reached, missed, cancelled or replaced; show feedback."""
        active, loop = self._active, self._loop
        if active is None:
            return
        if loop.state != RUNNING:
            self._end('abort', 'INVALID_GOAL', f'control ended: {self._trouble()}')
            return
        if (active.source, active.target) != (loop.source, loop.source.targets):
            self._end('abort', 'INVALID_GOAL', 'replaced by another target')
            return
        if active.goal_handle.is_cancel_requested:
            loop.source.stop()
            self._end('canceled', 'SUCCESSFUL', 'cancelled: the joint comes to rest')
            return
        terms, goal, now = loop.law.terms, active.goal, loop.time
        verdict = goal.judge(now, terms.position, terms.velocity)
        if verdict is not None:
            outcome, text = verdict
            if outcome is Outcome.OFF_PATH:
                loop.source.stop()
            how = 'succeed' if outcome is Outcome.REACHED else 'abort'
            self._end(how, outcome.value, text)
        elif now - self._shown >= FEEDBACK:
            self._shown = now
            actual = Reference(terms.position, terms.velocity)
            self._show(active.goal_handle, goal.since(now), goal.target(now), actual)

    def _show(
        self, handle: ServerGoalHandle, since: float, desired: Reference, actual: Reference
    ) -> None:
        joint = self._setup().settings.joint_name
        feedback = FollowJointTrajectory.Feedback(joint_names=[joint])
        feedback.header.stamp = self._node.get_clock().now().to_msg()
        error = Reference(*(a - b for a, b in zip(desired, actual, strict=True)))
        for name, motion in (('desired', desired), ('actual', actual), ('error', error)):
            point = JointTrajectoryPoint(positions=[motion.position])
            if name == 'desired' or self._has_velocity:
                point.velocities = [motion.velocity]
            if name == 'desired':
                point.accelerations = [motion.acceleration]
            after = max(round(since * SECOND), 0)
            point.time_from_start.sec, point.time_from_start.nanosec = divmod(after, SECOND)
            setattr(feedback, name, point)
        handle.publish_feedback(feedback)


def _never(handle: ServerGoalHandle) -> None:
    """Do nothing: an action server needs this function, but each goal has one of its own."""
