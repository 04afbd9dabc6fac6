# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A joint with muscles, load and effects as equations of motion, and their integrator."""
