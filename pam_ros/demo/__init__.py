# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the demonstration makes of recorded runs: numbers beside the paper's, and figures."""
