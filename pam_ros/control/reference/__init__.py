# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The desired position of the load: smooth motion to targets, and trajectories."""
