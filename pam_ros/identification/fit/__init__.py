# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fit a model to recordings: what its residuals are made of, and what the data say of it."""
