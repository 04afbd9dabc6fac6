# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where the load shall be: targets that are approached smoothly, and trajectories."""
