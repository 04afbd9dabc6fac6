# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated rig of a bench, and the run of a controller over topics."""
