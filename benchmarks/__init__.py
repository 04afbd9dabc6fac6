# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the package claims about speed and precision: one file per claim, each with main()."""
