# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The programs: thin ROS nodes and command lines over the pure rooms."""
