# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The state of the controlled joint, read from joint states."""

from math import isfinite
from typing import NamedTuple

from sensor_msgs.msg import JointState

from pam_ros.errors import RangeError
from pam_ros.nodes.common.stamps import stamp_of


class MeasuredState(NamedTuple):
    """A measured state: ns (0 without a stamp), m or rad, m/s or rad/s (None if not used)."""

    stamp: int
    position: float
    velocity: float | None


def measured_state(message: JointState, joint: str, needs_velocity: bool) -> MeasuredState:
    """Return the state of *joint*; raises RangeError if the message has no usable state of it."""
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
    return MeasuredState(stamp_of(message), position, velocity if needs_velocity else None)
