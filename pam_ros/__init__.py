# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pneumatic artificial muscles: simulate, control, identify."""

__version__ = '0.1.0'
