# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A client of the action follow_joint_trajectory, as a program: one line of JSON for each goal.

The first line of its input is a list of goals in JSON. Each has the ``points`` of its trajectory:
time in s, position, and velocity if there is one. Further keys: ``joint``, ``stamp`` in s,
``path`` and ``end`` with tolerances of position, velocity and acceleration, ``of`` with the joint
of these tolerances, ``goal_time_tolerance`` in s. After ``patience`` messages of feedback
it is cancelled, or the next goal is sent if ``is_replaced`` is true.
"""

import json
import sys

import rclpy
from builtin_interfaces.msg import Duration, Time
from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointTolerance
from rclpy.action import ActionClient
from rclpy.qos import QoSProfile
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

NAME = '/pam_control/follow_joint_trajectory'
DEADLINE = 200.0  # s; bounds how long a broken server may hang the test


def parts(seconds):
    """Return whole seconds and nanoseconds."""
    sec, nanosec = divmod(round(seconds * 1e9), 10**9)
    return {'sec': sec, 'nanosec': nanosec}


def goal_of(given):
    """Return the goal that JSON describes."""
    joint = given.get('joint', 'pam')
    trajectory = JointTrajectory(joint_names=[joint])
    trajectory.header.stamp = Time(**parts(given.get('stamp', 0.0)))
    for time, position, *velocity in given['points']:
        point = JointTrajectoryPoint(positions=[position], velocities=velocity)
        point.time_from_start = Duration(**parts(time))
        trajectory.points.append(point)
    goal = FollowJointTrajectory.Goal(trajectory=trajectory)
    for name, tolerances in (('path', goal.path_tolerance), ('end', goal.goal_tolerance)):
        if name in given:
            of = zip(('position', 'velocity', 'acceleration'), given[name], strict=False)
            tolerances.append(JointTolerance(name=given.get('of', joint), **dict(of)))
    goal.goal_time_tolerance = Duration(**parts(given.get('goal_time_tolerance', 0.0)))
    return goal


def shown(point):
    """Return the numbers of a point of the feedback."""
    time = point.time_from_start.sec + 1e-9 * point.time_from_start.nanosec
    return [time, *point.positions, *point.velocities]


def main():
    """Send the goals, and print what became of each."""
    rclpy.init()
    node = rclpy.create_node('follow_client')
    # In lockstep feedback comes ten times as often: a client that waits for a core loses none.
    every = QoSProfile(depth=1000)
    client = ActionClient(node, FollowJointTrajectory, NAME, feedback_sub_qos_profile=every)
    assert client.wait_for_server(DEADLINE), 'there is no server'

    def wait(future):
        rclpy.spin_until_future_complete(node, future, timeout_sec=DEADLINE)
        assert future.done(), 'no answer'
        return future.result()

    waiting = []
    for given in json.loads(sys.stdin.readline()):
        feedback = []
        handle = wait(client.send_goal_async(goal_of(given), lambda m, to=feedback: to.append(m)))
        if not handle.accepted:
            waiting.append(None)
            continue
        result = handle.get_result_async()
        waiting.append((result, feedback))
        if 'patience' in given:
            while len(feedback) < given['patience']:
                rclpy.spin_once(node, timeout_sec=DEADLINE)
            if not given.get('is_replaced'):
                wait(handle.cancel_goal_async())
        if not given.get('is_replaced'):
            wait(result)
    for one in waiting:
        if one is None:
            print(json.dumps({'accepted': False}), flush=True)
            continue
        future, feedback = one
        found = wait(future)
        print(
            json.dumps(
                {
                    'accepted': True,
                    'status': found.status,
                    'code': found.result.error_code,
                    'text': found.result.error_string,
                    'joints': [list(m.feedback.joint_names) for m in feedback[:1]],
                    'feedback': [
                        [
                            shown(getattr(m.feedback, what))
                            for what in ('desired', 'actual', 'error')
                        ]
                        for m in feedback
                    ],
                }
            ),
            flush=True,
        )
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
