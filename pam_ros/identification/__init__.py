# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""From a recording to the residual of the declared model, and to the effect that it lacks."""
