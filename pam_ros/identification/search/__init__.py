# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The search for effects that a model lacks: moves between models, decided by one score."""
