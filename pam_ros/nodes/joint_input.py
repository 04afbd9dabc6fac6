# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Read one joint out of JointState messages."""

import math

from sensor_msgs.msg import JointState

from pam_ros.control.loop import Reading

SECOND = 1_000_000_000
CREDIBLE = SECOND // 5  # ns by which a stamp may differ from its arrival


class JointInput:
    """The joint of a name, or the only one where the name is empty.

    ``problem`` says what is wrong with the messages, '' for nothing; ``accepted`` and ``refused``
    count them.
    """

    def __init__(self, name: str) -> None:
        """Look for a joint of this *name*."""
        self.name = name
        self.problem = ''
        self.accepted = self.refused = 0

    def take(self, message: JointState, arrival: int) -> Reading | None:
        """Return what a message that came at ROS time *arrival* in ns says, None where nothing.

        It is dated by its stamp, or by its arrival where the stamp cannot be.
        """
        self.problem, index = self._find(message)
        if self.problem:
            self.refused += 1
            return None
        self.accepted += 1
        stamp = message.header.stamp
        time = stamp.sec * SECOND + stamp.nanosec
        if not 0 <= arrival - time < CREDIBLE:
            time = arrival
        velocity = message.velocity[index] if len(message.velocity) > index else None
        if velocity is not None and not math.isfinite(velocity):
            velocity = None
        return Reading(time / SECOND, message.position[index], velocity)

    def _find(self, message: JointState) -> tuple[str, int]:
        """Return what is wrong with a message, and where the joint is in it."""
        names = list(message.name)
        there = ', '.join(names) or 'none'
        if self.name and self.name not in names:
            return f'joint_states has no joint {self.name!r}: it has {there}', 0
        if not self.name and len(names) != 1:
            return (
                f'joint_states has {len(names)} joints ({there}): choose one with the parameter '
                'joint_name',
                0,
            )
        index = names.index(self.name) if self.name else 0
        if len(message.position) <= index:
            return f'joint_states carries no position of {names[index]!r}', 0
        if not math.isfinite(message.position[index]):
            return f'position {message.position[index]} of {names[index]!r} is no number', 0
        return '', index
