# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How a program is doing, in a level, a sentence and numbers."""
