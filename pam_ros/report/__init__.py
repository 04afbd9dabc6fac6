# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The files of an identification: numbers, a page to read, a parameter file, the residuals."""
