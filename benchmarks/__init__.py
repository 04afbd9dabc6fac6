# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Measure the claims of the package about speed and precision, each with main() of a file."""
