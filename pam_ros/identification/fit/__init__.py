# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fit a model to recordings: the model of its residuals, and the information in the data."""
