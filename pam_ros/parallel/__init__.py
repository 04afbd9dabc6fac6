# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Many independent tasks side by side: in processes of this machine, or of a Dask cluster."""
