# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Programs as processes: started, scheduled, interrupted, stopped."""
