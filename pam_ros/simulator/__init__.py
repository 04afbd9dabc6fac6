# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""All of the simulator but ROS: valves, rig and sensors, step by step."""
