# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A plugin of pytest that hides Sybil, as where only the packages of rosdep are installed."""

import sys

sys.modules['sybil'] = None
