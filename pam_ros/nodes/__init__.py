# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS nodes: thin layers over the packages without ROS; every module here imports ROS."""
