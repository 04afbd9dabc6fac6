# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pressure programmes that excite the effects of a muscle, and limits for safe operation."""
