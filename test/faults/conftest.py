# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Each fault once, or twenty times with ``--full``, and then by each kind of end."""

import signal

import pytest

from support.harness import Peer

TIMES = 20
# How a process ends, and its exit code; the quick run tries the harder one.
ENDS = [(signal.SIGKILL, -signal.SIGKILL), (signal.SIGTERM, 0)]


def pytest_generate_tests(metafunc):
    is_full = metafunc.config.getoption('full')
    if 'turn' in metafunc.fixturenames:
        metafunc.parametrize('turn', range(TIMES if is_full else 1))
    if 'kind' in metafunc.fixturenames:
        metafunc.parametrize(('kind', 'code'), ENDS if is_full else ENDS[:1])


@pytest.fixture(scope='module')
def module_peer(module_domain):
    with Peer() as peer:
        yield peer
