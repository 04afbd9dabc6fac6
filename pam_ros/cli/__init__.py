# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The programs that a user starts: light modules that handle signals before they import more."""
