# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the law learns from the motion: the force and the lag that the nominal model lacks."""
