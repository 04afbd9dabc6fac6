# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A node of the test for every test of a node, in a ROS domain that this test alone has."""

import pytest

from support.harness import Peer


@pytest.fixture
def peer(domain):
    with Peer() as peer:
        yield peer
