# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Scenarios that are drawn at random: a rig, what it has that is not declared, and a reference."""
