# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Cases of a test that run before a release: ``make test-all``."""

import pytest


def at_release(*values):
    """Return a case of ``parametrize`` with these values that runs before a release only."""
    return pytest.param(*values, marks=pytest.mark.release)
