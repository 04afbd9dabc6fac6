# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What tests of several parts of a search begin with."""

import pytest

from support.rounds import MODEL, setting_of
from truth import effect


@pytest.fixture(scope='package')
def setting():
    """Return the setting of a rig with friction and a lag."""
    with setting_of(MODEL, effect('viscous_friction'), effect('pressure_lag')) as found:
        yield found
