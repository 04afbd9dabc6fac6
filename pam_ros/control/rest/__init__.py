# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The behaviour of the law while the reference rests: standstill, stiction, disturbances."""
