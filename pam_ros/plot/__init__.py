# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Plots of the signals of a rig: topics and their units, thinned, as a figure or as a page."""
