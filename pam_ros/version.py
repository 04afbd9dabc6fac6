# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The version of this package, the same as in setup.py and package.xml."""

__version__ = '0.1.0'
VERSION_LINE = f'pam_ros {__version__}'  # what each program prints for --version
VERSION_HELP = 'print the version of this package and end'
