# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The page of ``pam_plot`` in a real browser."""

import pytest

from pam_ros.plot.server import PageServer
from support.devtools import page_in
from support.plotted import READY, Shown


@pytest.fixture(scope='module')
def chromium(browser, tmp_path_factory):
    with page_in(browser, tmp_path_factory.mktemp('chromium')) as page:
        yield page


@pytest.fixture
def show(chromium):
    """Return a function that opens the page of a rig, and gives what can be done with it."""
    servers = []

    def opened(rig):
        server = PageServer(rig.look)
        server.start()
        servers.append(server)
        chromium.open(server.address)
        chromium.until(f"typeof sections !== 'undefined' && {READY}", 'the plots')
        return Shown(chromium)

    chromium.requests.clear()
    chromium.errors.clear()
    for old in chromium.downloads.iterdir():
        old.unlink()
    yield opened
    chromium.close()
    for server in servers:
        server.close()
    own = tuple(server.address for server in servers)
    foreign = [url for url in chromium.requests if not url.startswith((*own, 'data:', 'blob:'))]
    assert foreign == []
    assert chromium.errors == []
