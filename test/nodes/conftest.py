# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A node of the test for every test of a node."""

import pytest

from support.harness import Peer


@pytest.fixture
def peer():
    with Peer() as peer:
        yield peer
