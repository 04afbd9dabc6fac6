# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""All parts of the simulator except ROS: valves, rig and sensors, step by step."""
