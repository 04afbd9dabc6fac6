# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which ROS the tests run with, where Jazzy and Kilted differ."""

from importlib.metadata import PackageNotFoundError, version

JAZZY = 7  # first number of the version of its rclpy


def _is_jazzy() -> bool:
    try:
        return int(version('rclpy').partition('.')[0]) <= JAZZY
    except PackageNotFoundError:  # tests without ROS
        return True


IS_JAZZY = _is_jazzy()
# Fast DDS 3 reads the variable with its new name, and warns about the former one.
PROFILE = 'FASTRTPS_DEFAULT_PROFILES_FILE' if IS_JAZZY else 'FASTDDS_DEFAULT_PROFILES_FILE'
