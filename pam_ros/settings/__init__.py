# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is declared to the programs: tables of parameters, their files, and what values make."""
