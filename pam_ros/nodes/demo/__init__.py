# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The chapters of the demonstration, each a module with a function ``play``."""
