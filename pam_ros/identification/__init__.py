# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Identification: from a recording to the residual of the nominal model and to missing effects."""
