# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the programs are told: tables of parameters, their files, and what values make."""
