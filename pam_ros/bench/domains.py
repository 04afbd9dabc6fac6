# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""DDS domains of runs, in which no other program of this machine is present.

A controller that is tried must not reach a real rig, and runs side by side must not hear each
other. A domain is held by one of its own UDP ports, which no program of ROS uses; other programs
in a domain are seen from their ports.
"""

import os
import socket
from pathlib import Path

from pam_ros.errors import PamError

# The default mapping of DDS (RTPS 2.3, section 9.6.2.3): ports of domain d begin at 7400 + 250 d.
FIRST_PORT, PORTS = 7400, 250
DOMAINS = range(1, 101)  # 0 is the default; above 100 ports meet the ephemeral ones of Linux


def claim_domain(domain: int | None = None) -> tuple[int, socket.socket]:
    """Return a free domain, or *domain*, and the socket that holds it until it is closed.

    Raises PamError if no domain is free; *domain* is not checked.
    """
    if domain is not None:
        return domain, socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    used = _used_ports()
    # Processes begin at different ones, so that they rarely meet.
    for k in range(len(DOMAINS)):
        one = DOMAINS[(os.getpid() + k) % len(DOMAINS)]
        ports = range(FIRST_PORT + PORTS * one, FIRST_PORT + PORTS * (one + 1))
        if not used.isdisjoint(ports):
            continue
        lock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            lock.bind(('127.0.0.1', ports[-1]))
        except OSError:  # another process was faster
            lock.close()
            continue
        return one, lock
    raise PamError('all DDS domains from 1 to 100 are in use on this machine: give --domain')


def _used_ports() -> set[int]:
    """Return the UDP ports to which programs of this machine are bound."""
    found = set()
    for table in ('/proc/net/udp', '/proc/net/udp6'):
        try:
            lines = Path(table).read_text(encoding='ascii').splitlines()[1:]
        except OSError:  # another system than Linux: the lock alone decides
            continue
        found |= {int(line.split()[1].rpartition(':')[2], 16) for line in lines}
    return found
