# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a trace found, written down: numbers, a page to read, a parameter file, the residuals."""
