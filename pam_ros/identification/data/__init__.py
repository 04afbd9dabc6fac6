# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings prepared for fits: gapless segments, their noise, thinned copies of them."""
