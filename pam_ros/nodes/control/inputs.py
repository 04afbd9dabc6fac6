# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a controller reads from messages: the state of its joint, and trajectories for it."""

from math import isfinite
from typing import NamedTuple

from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from pam_ros.control.reference.trajectory import Point
from pam_ros.errors import RangeError
from pam_ros.nodes.common.stamps import stamp_of
from pam_ros.timing.pace import SECOND


class Sight(NamedTuple):
    """A measured state: ns (0 where there is no stamp), m, m/s where it is measured."""

    stamp: int
    position: float
    velocity: float | None


def sight_of(message: JointState, joint: str, needs_velocity: bool) -> Sight:
    """Return the state of *joint*; raises RangeError where the message has none that is usable."""
    try:
        i = message.name.index(joint)
    except ValueError:
        there = ', '.join(message.name) or 'no joint at all'
        raise RangeError(f'joint_states has no joint {joint} (joint_name), but {there}') from None
    if i >= len(message.position):
        raise RangeError(f'joint_states has no position for joint {joint}')
    position = message.position[i]
    if not isfinite(position):
        raise RangeError(f'joint_states has position {position} for joint {joint}: not used')
    velocity = message.velocity[i] if i < len(message.velocity) else None
    if needs_velocity and (velocity is None or not isfinite(velocity)):
        raise RangeError(
            f'joint_states has {"no" if velocity is None else velocity} velocity for joint '
            f'{joint}, which velocity_source = measured needs'
        )
    return Sight(stamp_of(message), position, velocity if needs_velocity else None)


def points_of(message: JointTrajectory, joint: str) -> list[Point]:
    """Return the points that are for *joint*; raises RangeError where there can be none."""
    names = list(message.joint_names)
    if not message.points:
        return []
    if joint not in names:
        there = ', '.join(names) or 'no joint at all'
        raise RangeError(f'joint_trajectory is not for joint {joint} (joint_name), but {there}')
    i, count = names.index(joint), len(names)
    return [_point(n, point, i, count) for n, point in enumerate(message.points)]


def _point(n: int, point: JointTrajectoryPoint, i: int, count: int) -> Point:
    def value(kind: str) -> float | None:
        values = getattr(point, kind)
        if not len(values) and kind != 'positions':
            return None
        if len(values) != count:
            raise RangeError(
                f'point {n} of the trajectory has {len(values)} {kind} for {count} joints'
            )
        return float(values[i])

    time = point.time_from_start.sec + point.time_from_start.nanosec / SECOND
    position = value('positions')
    assert position is not None
    return Point(time, position, value('velocities'), value('accelerations'))
