# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A domain that a test has claimed: nobody else claims it, and nobody else is present in it."""

import os
import socket
import subprocess
import sys
from contextlib import ExitStack, contextmanager
from itertools import count
from pathlib import Path
from time import monotonic

import pytest
from sensor_msgs.msg import JointState

from support import domain as domains
from support.distribution import PROFILE
from support.domain import DOMAINS, claimed, heard_domains, ports_of, programs_in
from support.harness import DEADLINE, FreshProgram

HERE = Path(__file__).parents[2]
# Once it reads the line, it claims a domain again and again, of all that there are always the
# first that it can have, and notes it in a file that must not be there yet.
CLAIM_OFTEN = """
import sys
from itertools import count
from pathlib import Path
from time import sleep
from support import domain

print('ready', flush=True)
input()
for _ in range(100):
    domain._turns = count()
    with domain.claimed() as number:
        held = Path(sys.argv[1], str(number))
        held.touch(exist_ok=False)
        sleep(0.002)
        held.unlink()
        print(number)
"""
CLAIM_AND_STAY = """
from support.domain import claimed

with claimed() as number:
    print(number, flush=True)
    input()
"""
# Another test run: it claims a domain, publishes in it and goes on to the next one.
NEIGHBOUR = """
from sensor_msgs.msg import JointState
from support.domain import claimed
from support.harness import Peer

while True:
    with claimed(), Peer() as peer:
        publisher = peer.node.create_publisher(JointState, 'joint_states', 10)
        for _ in range(5):
            publisher.publish(JointState(name=['neighbour']))
            peer.work(0.05)
        print('published', flush=True)
"""
# What a stranger hears in the domain: the names of joints and of simulators.
LISTEN = """
import sys
from sensor_msgs.msg import JointState
from pam_ros.nodes.demo.client import Client

with Client() as client:
    states = client.collect(JointState, 'joint_states')
    client.until(lambda: any(m.name == ['stranger'] for m in states), 'the stranger')
    client.work(1.0)
    nodes = client.node.get_node_names()
    print(*sorted({m.name[0] for m in states}), *(n for n in nodes if n.startswith('pam_sim')))
"""


def start(code, *arguments, **options):
    """Start a Python program that sees what the tests share."""
    return subprocess.Popen(
        [sys.executable, '-c', code, *map(str, arguments)],
        env={**os.environ, 'PYTHONPATH': f'{HERE}{os.pathsep}{HERE.parent}'},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        **options,
    )


@pytest.fixture
def begin_at(monkeypatch):
    """Return a function that lets the next claim begin its search at a domain."""

    def next_claim(domain):
        monkeypatch.setattr(domains, '_turns', count(DOMAINS.index(domain)))

    return next_claim


@pytest.fixture
def comes_free(begin_at):
    """Return a function that waits until it can claim a domain: another run may have it by now."""

    def until_claimed(domain):
        end, found = monotonic() + DEADLINE, None
        while found != domain:
            assert monotonic() < end
            begin_at(domain)
            with claimed() as found:
                pass

    return until_claimed


@pytest.fixture
def free():
    """Return a domain that nobody has."""
    with claimed() as number:
        pass
    return number


def test_of_two_that_claim_at_once_each_has_its_own(tmp_path):
    both = [start(CLAIM_OFTEN, tmp_path) for _ in range(2)]
    for process in both:
        assert process.stdout.readline() == 'ready\n'
    for process in both:
        process.stdin.write('begin\n')
        process.stdin.flush()
    claimed = [process.communicate()[0].split() for process in both]
    assert [process.returncode for process in both] == [0, 0]
    assert [len(numbers) for numbers in claimed] == [100, 100]
    assert len({number for numbers in claimed for number in numbers}) > 1  # they met


def test_a_claimed_domain_is_passed_to_child_processes_and_released_at_the_end(
    begin_at, comes_free
):
    before = os.environ['ROS_DOMAIN_ID']
    with claimed() as number:
        assert os.environ['ROS_DOMAIN_ID'] == str(number)
        begin_at(number)
        with claimed() as other:
            assert other != number
        assert os.environ['ROS_DOMAIN_ID'] == str(number)
    assert os.environ['ROS_DOMAIN_ID'] == before
    comes_free(number)


def test_the_claim_of_a_test_that_is_killed_ends_with_it(begin_at, comes_free):
    held = start(CLAIM_AND_STAY)
    number = int(held.stdout.readline())
    begin_at(number)
    with claimed() as other:
        assert other != number
    held.kill()
    held.communicate()
    comes_free(number)


def test_a_domain_in_which_somebody_listens_is_left_alone(free, begin_at):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
        listener.bind(('0.0.0.0', ports_of(free)[10]))
        assert free in heard_domains()
        begin_at(free)
        with claimed() as other:
            assert other != free


@contextmanager
def sleeping(environment):
    """Hold a program that does nothing, started with these environment variables.

    A new process runs some time before the kernel shows its variables to others.
    """
    with subprocess.Popen(['sleep', '600'], env=environment) as program:
        try:
            while not Path(f'/proc/{program.pid}/environ').read_bytes():
                assert program.poll() is None
            yield program
        finally:
            program.kill()


def test_a_domain_in_which_somebody_starts_is_left_alone(free, begin_at):
    """What a killed test has started may have no ports yet."""
    environment = {**os.environ, 'ROS_DOMAIN_ID': str(free)}
    with sleeping(environment) as left:
        assert programs_in(free) == [left.pid]
        begin_at(free)
        with claimed() as other:
            assert other != free
        # A shell of somebody else, who has chosen the same domain for what he does, is no matter.
        del environment[PROFILE]
        with sleeping(environment):
            assert programs_in(free) == [left.pid]


def test_a_program_that_is_left_running_is_reported(monkeypatch):
    monkeypatch.setattr(domains, 'PATIENCE', 0.1)
    with ExitStack() as stack, pytest.raises(RuntimeError, match='still runs'), claimed():
        stack.enter_context(sleeping(os.environ))


def test_the_ports_of_the_tests_are_not_those_of_others():
    for domain in DOMAINS:
        ours = ports_of(domain)
        assert len(ours) == 125
        # The mapping of DDS-RTPS for programs without the profile, of some sixty programs.
        first = 7400 + 250 * domain
        assert not set(ours) & {first, first + 1, *range(first + 10, first + 124)}
        assert ours[-1] < 32_768  # where Linux begins to give ports to anybody
        # Announcements go to the even ports of others, so that ours are odd.
        assert (ours[0] - first) % 2 == 1


@pytest.mark.at_any_pace
def test_nodes_of_others_in_the_same_domain_are_not_received(domain, peer, monkeypatch):
    """Neither programs of the same domain that load no profile, nor another run of tests."""
    states = peer.collect(JointState, 'joint_states')
    with monkeypatch.context() as patch:
        patch.delenv(PROFILE)
        patch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET')
        stranger = FreshProgram(
            'pam_sim', '-r', '__node:=pam_sim_stranger', parameters={'joint_name': 'stranger'}
        )
        listener = start(LISTEN)
    neighbour = start(NEIGHBOUR)
    try:
        with stranger, FreshProgram('pam_sim', parameters={'joint_name': 'ours'}):
            peer.more(states)
            received, _ = listener.communicate()
            assert neighbour.stdout.readline() == 'published\n'
            # All that are received at all are received within some announcements.
            peer.work(1.0)
            assert {m.name[0] for m in states} == {'ours'}
            assert {n for n in peer.node.get_node_names() if n.startswith('pam')} == {
                'pam_sim',
                peer.node.get_name(),
            }
            assert neighbour.poll() is None
    finally:
        neighbour.kill()
        neighbour.communicate()
    # Nor do they hear the test, though they hear each other.
    assert received.split() == ['stranger', 'pam_sim_stranger']


def uses_shared_memory(pid):
    """Say whether a process holds a file of Fast DDS's shared memory open."""
    files = Path(f'/proc/{pid}/fd').iterdir()
    names = ('/dev/shm/fastrtps', '/dev/shm/fastdds')
    return any(os.path.realpath(file).startswith(names) for file in files)


@pytest.mark.at_any_pace
def test_no_program_uses_shared_memory(domain, peer, monkeypatch):
    """Connections in it are lost for ever where tests kill programs; others do use it."""
    assert not uses_shared_memory(os.getpid())
    with FreshProgram('pam_sim', parameters={'joint_name': 'ours'}) as program:
        peer.more(peer.collect(JointState, 'joint_states'))
        assert not uses_shared_memory(program.process.pid)
    monkeypatch.delenv(PROFILE)
    other = start(LISTEN)
    try:
        peer.until(lambda: uses_shared_memory(other.pid), 'the shared memory of another program')
    finally:
        other.kill()
        other.communicate()
