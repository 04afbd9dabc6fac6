# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tables in text files and workbooks: names, units and rows of cells, numbers and times."""
