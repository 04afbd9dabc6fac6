# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The stamps of messages."""

from sensor_msgs.msg import FluidPressure, JointState

from pam_ros.timing.pace import SECOND


def stamp_of(message: FluidPressure | JointState) -> int:
    """Return the stamp in ns."""
    return message.header.stamp.sec * SECOND + message.header.stamp.nanosec
