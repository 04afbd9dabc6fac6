# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Evaluation of the demonstration's recorded runs: numbers next to the paper's, and figures."""
