# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One muscle according to the paper: force, stiffness, damping, inverse, units, limits."""
