# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The quality of service of a recorder's subscriptions, and of publishers in a bag."""

from typing import Any

from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

DEPTH = 20_000  # messages of a topic that the middleware keeps while the disk is busy


def matching(offered: list[QoSProfile]) -> QoSProfile:
    """Return the best profile with which messages of all publishers are received."""
    reliable = all(q.reliability == ReliabilityPolicy.RELIABLE for q in offered)
    lasting = all(q.durability == DurabilityPolicy.TRANSIENT_LOCAL for q in offered)
    return QoSProfile(
        depth=DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if lasting else DurabilityPolicy.VOLATILE,
    )


def metadata(profile: QoSProfile) -> dict[str, Any]:
    """Return a publisher's profile in the format of rosbag2's metadata."""
    return {
        'history': profile.history.name.lower(),
        'depth': profile.depth,
        'reliability': profile.reliability.name.lower(),
        'durability': profile.durability.name.lower(),
        'deadline': _time(profile.deadline),
        'lifespan': _time(profile.lifespan),
        'liveliness': profile.liveliness.name.lower(),
        'liveliness_lease_duration': _time(profile.liveliness_lease_duration),
        'avoid_ros_namespace_conventions': profile.avoid_ros_namespace_conventions,
    }


def _time(duration: Duration) -> dict[str, int]:
    seconds, nanoseconds = divmod(duration.nanoseconds, 10**9)
    return {'sec': seconds, 'nsec': nanoseconds}
