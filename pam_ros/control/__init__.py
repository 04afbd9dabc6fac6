# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Position control of a joint: reference, control laws, and their models of the rig."""
