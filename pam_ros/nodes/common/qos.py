# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The quality of service of our topics, which a user may override."""

from rclpy.qos_overriding_options import QoSOverridingOptions

DEPTH = 10


def open_qos() -> QoSOverridingOptions:
    """Let a user change history, depth and reliability by ``qos_overrides`` parameters."""
    return QoSOverridingOptions.with_default_policies()
