# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Commands that a person types: values with units, command lines, and their checks."""
