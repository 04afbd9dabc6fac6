# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of the programs: their tables, their files, and the objects built from them."""
