# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Domains of runs are held by one process at a time, and none is one that somebody listens in."""

import socket

from pam_ros.bench.domains import DOMAINS, FIRST_PORT, PORTS, claim_domain


def test_no_domain_is_claimed_twice():
    claims = [claim_domain() for _ in range(5)]
    try:
        domains = [domain for domain, _ in claims]
        assert len(set(domains)) == 5
        assert set(domains) <= set(DOMAINS)
    finally:
        for _, lock in claims:
            lock.close()


def test_a_domain_in_which_a_program_listens_is_left_alone():
    first, lock = claim_domain()
    lock.close()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
        listener.bind(('', FIRST_PORT + PORTS * first + 11))
        second, other = claim_domain()
        other.close()
    assert second != first


def test_a_given_domain_is_used():
    domain, lock = claim_domain(42)
    lock.close()
    assert domain == 42
