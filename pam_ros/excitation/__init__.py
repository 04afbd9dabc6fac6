# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pressure programmes that bring out what a muscle does, and the limits that keep it safe."""
