# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The identification of many rigs: a report for each, and one table of all."""
