# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which effects a model lacks: moves from model to model, decided by one score."""
