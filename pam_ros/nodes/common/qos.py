# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The quality of service of the package's topics, which a user may override."""

from math import ceil

from rclpy.qos_overriding_options import QoSOverridingOptions

DEPTH = 10
# s of states that a simulator can send again. After a delay it publishes up to half a second of
# states at once. This is more than the shared memory of the middleware holds until a recorder,
# which is delayed by this, takes them. To send them again takes up to another second
# (benchmarks.soak).
KEPT = 2.0


def states_depth(rate: float) -> int:
    """Return how many states a publisher keeps that publishes them at *rate* in Hz."""
    return max(DEPTH, ceil(KEPT * rate))


def open_qos() -> QoSOverridingOptions:
    """Let a user change history, depth and reliability by ``qos_overrides`` parameters."""
    return QoSOverridingOptions.with_default_policies()
