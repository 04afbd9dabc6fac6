# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Measured experiments: rosbag2 directories and CSV files, read into SI arrays on one clock."""
