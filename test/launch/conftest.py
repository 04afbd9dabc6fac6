# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tests of launch files with launch_testing, which comes with an installed ROS only."""

import importlib.util

HAVE_LAUNCH_TESTING = importlib.util.find_spec('launch_testing') is not None
# A launch test is collected by the plugin of launch_testing, and means nothing without it.
collect_ignore = [] if HAVE_LAUNCH_TESTING else ['test_closed_loop_launch.py']


def pytest_report_header():
    """Say where the launch test is not run."""
    return [] if HAVE_LAUNCH_TESTING else 'without launch_testing: the launch test is not run'
