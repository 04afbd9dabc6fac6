# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the law does while the reference rests: calm, stiction, disturbances."""
