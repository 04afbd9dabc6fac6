# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A ROS domain of its own for each test run, so that no run hears another one."""

import fcntl
import os
import tempfile
from pathlib import Path
from typing import TextIO

DOMAINS = range(1, 102)  # 0 is everybody's; above 101 the ports meet Linux' ephemeral ones
FIRST_PORT, PORTS_A_DOMAIN = 7400, 250  # the DDS-RTPS well-known port mapping


def heard_domains() -> set[int]:
    """Return the domains that some program on this machine listens in, from its UDP ports."""
    heard = set()
    for table in ('/proc/net/udp', '/proc/net/udp6'):
        try:
            lines = Path(table).read_text().splitlines()[1:]
        except OSError:
            continue
        ports = (int(line.split()[1].rpartition(':')[2], 16) for line in lines)
        heard.update((port - FIRST_PORT) // PORTS_A_DOMAIN for port in ports)
    return heard


def claim_domain() -> tuple[int, TextIO]:
    """Return a free domain and the locked file that keeps other test runs off while it is open.

    The search starts at a place that the process id chooses.
    """
    heard = heard_domains()
    for turn in range(len(DOMAINS)):
        domain = DOMAINS[(os.getpid() + turn) % len(DOMAINS)]
        if domain in heard:
            continue
        lock_file = Path(tempfile.gettempdir(), f'pam_ros_test_domain_{domain}.lock')
        try:
            lock = lock_file.open('a')
        except PermissionError:  # another user's
            continue
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            lock.close()
            continue
        return domain, lock
    raise RuntimeError('all ROS domains from 1 to 101 are in use on this machine')
