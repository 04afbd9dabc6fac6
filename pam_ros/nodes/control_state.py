# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a position law finds, as one stamped message that plotting tools draw by name."""

from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

from pam_ros.control.signals import Terms
from pam_ros.nodes.pace import SECOND
from pam_ros.nodes.telemetry import DEPTH, open_qos

ROWS = ('reference', 'error', 'surface', 'learned', 'limit')


class ControlState:
    """Publishes ``~/state``: a JointState whose rows are not joints but the terms of the law.

    Each number is in its column's unit, so that tools show it rightly: m, m/s, N. Row by row:

        reference   position, velocity, force that the model wants for it (equivalent)
        error       position error, -, force of the disturbance observer
        surface     -, sliding variable, switching force
        learned     -, -, force fed forward from what was learned
        limit       -, -, force that was wanted and is cut off by a limit; 0: not saturated

    A message of a type of one's own would have to be installed wherever it is looked at.
    """

    def __init__(self, node: Node) -> None:
        """Create the publisher on *node*."""
        n = len(ROWS)
        self._message = JointState(
            name=list(ROWS), position=[0.0] * n, velocity=[0.0] * n, effort=[0.0] * n
        )
        self._publisher = node.create_publisher(
            JointState, '~/state', QoSProfile(depth=DEPTH), qos_overriding_options=open_qos()
        )

    def publish(self, stamp: int, terms: Terms) -> None:
        """Publish the *terms* of the step at ROS time *stamp* in ns."""
        message = self._message
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
        position, velocity, effort = message.position, message.velocity, message.effort
        position[0], velocity[0], effort[0] = terms.reference, terms.speed, terms.equivalent
        position[1], effort[1] = terms.error, terms.observer
        velocity[2], effort[2] = terms.surface, terms.switching
        effort[3], effort[4] = terms.learned, terms.cut
        self._publisher.publish(message)
