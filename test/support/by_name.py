# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The effects of a joint or of a muscle, looked up by their names."""


def by_name(effects):
    """Return *effects* by name."""
    return {effect.name: effect for effect in effects}
