# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The health of a program: a level, a sentence and numbers."""
