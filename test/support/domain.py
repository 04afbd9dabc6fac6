# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A ROS domain for each test of nodes, in which nobody else on this machine is present.

The programs of a domain find each other on UDP ports that follow from its number.
``discovery.xml`` moves these ports away from those of programs that do not load it, and a domain
is claimed by one of its own ports, which no program of ROS uses. A claim ends with the process
that holds it, however that ends.
"""

import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from time import monotonic, sleep
from xml.etree import ElementTree

from support.distribution import PROFILE
from support.forked import forked_in

DISCOVERY = Path(__file__).with_name('discovery.xml')
DOMAINS = range(1, 101)  # 0 is everybody's; above 100 the ports meet Linux' ephemeral ones
PATIENCE = 10.0  # s that the programs of a test may take to end once they were stopped
TURN = 0.02  # s
NOT_CLAIMED = 'claimed by no test: it has to use the fixture domain'
_turns = count(os.getpid())


def _constant_of(name: str) -> int:
    """Return a number of the port mapping in the file that all programs of the tests load."""
    (element,) = ElementTree.parse(DISCOVERY).iter(f'{{http://www.eprosima.com}}{name}')
    return int(element.text or '')


FIRST_PORT, PORTS_A_DOMAIN = _constant_of('portBase'), _constant_of('domainIDGain')


def ports_of(domain: int) -> range:
    """Return the ports of a domain: half of the gain, the other half is of all other programs.

    The last of them is what a claim holds. Programs take them from the first on, two each.
    """
    first = FIRST_PORT + PORTS_A_DOMAIN * domain
    return range(first, first + PORTS_A_DOMAIN // 2)


def heard_domains() -> set[int]:
    """Return the domains that some program on this machine listens in, from its UDP ports."""
    bound = _bound_ports()
    return {domain for domain in DOMAINS if not bound.isdisjoint(ports_of(domain)[:-1])}


def programs_in(domain: int) -> list[int]:
    """Return the process ids of programs that were started in a domain of ours (Linux).

    From their environment variables, so that those are seen that listen to nothing yet.
    """
    wanted = f'ROS_DOMAIN_ID={domain}'.encode()
    found = []
    for folder in Path('/proc').glob('[0-9]*'):
        try:
            variables = (folder / 'environ').read_bytes().split(b'\0')
        except OSError:  # it has ended meanwhile, or is another user's
            continue
        if wanted in variables and any(
            one.startswith(os.fsencode(PROFILE)) and one.endswith(os.fsencode(DISCOVERY.name))
            for one in variables
        ):
            found.append(int(folder.name))
    return found


@contextmanager
def claimed() -> Iterator[int]:
    """Hold a domain for what is started here, and tell its number.

    Nobody else can claim it, and nobody listens in it. In the end it is waited for the programs
    that were started in it.

    Raises RuntimeError if one of them does not end.
    """
    before = os.environ.get('ROS_DOMAIN_ID')
    with _claim() as domain:
        os.environ['ROS_DOMAIN_ID'] = str(domain)
        try:
            yield domain
        finally:
            if before is None:
                del os.environ['ROS_DOMAIN_ID']
            else:
                os.environ['ROS_DOMAIN_ID'] = before
        end = monotonic() + PATIENCE
        while left := programs_in(domain) + forked_in(domain):
            if monotonic() > end:
                raise RuntimeError(f'what was started in ROS domain {domain} still runs: {left}')
            sleep(TURN)


@contextmanager
def _claim() -> Iterator[int]:
    """Hold the first domain that is free, going on from the one before."""
    for _ in DOMAINS:
        domain = DOMAINS[next(_turns) % len(DOMAINS)]
        # Not handed on to programs that are started: the claim ends with this process.
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as lock:
            try:
                lock.bind(('127.0.0.1', ports_of(domain)[-1]))
            except OSError:  # somebody has claimed it
                continue
            # What a test has left behind that was killed may still be there.
            if domain not in heard_domains() and not programs_in(domain):
                yield domain
                return
    raise RuntimeError('all ROS domains from 1 to 100 are in use on this machine')


def _bound_ports() -> set[int]:
    """Return the UDP ports of this machine that some program is bound to."""
    bound = set()
    for table in ('/proc/net/udp', '/proc/net/udp6'):
        try:
            lines = Path(table).read_text().splitlines()[1:]
        except OSError:
            continue
        bound.update(int(line.split()[1].rpartition(':')[2], 16) for line in lines)
    return bound
