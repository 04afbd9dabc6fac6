# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The controller of the examples, on a simulator in lockstep; a tutorial shows its text."""

import signal
import subprocess
import sys

import numpy as np
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from support.harness import DEADLINE, Peer, Program, lose_nothing
from support.pages import DOCS, ROOT, blocks

pytestmark = pytest.mark.at_any_pace

FILE = ROOT / 'examples' / 'own_controller.py'
LENGTH = 2700  # states of 2 ms, so that the error decays to micrometres
AGAIN = 500  # of a second run


@pytest.fixture
def peer(domain):
    with Peer() as peer:
        yield peer


def test_the_tutorial_shows_the_file_below_its_license():
    text = FILE.read_text(encoding='utf-8')
    assert blocks(DOCS / 'tutorials' / 'your_own_controller.md', 'python') == [
        text.split('\n', 2)[2]
    ]
    assert len(text.splitlines()) <= 60


def positions(peer, length):
    """Return the first positions of a simulator in lockstep with the controller."""
    states = peer.collect(JointState, 'joint_states')
    parameters = {'muscle': 'dmsp_20_400n', 'time_mode': 'lockstep', **lose_nothing()}
    with Program('pam_sim', parameters=parameters):
        # Published again and again until there is a controller: all that follow are received.
        peer.more(states)
        controller = subprocess.Popen([sys.executable, FILE], stdout=subprocess.DEVNULL)
        try:
            peer.until(lambda: len(states) > length + 50 or controller.poll(), 'the states')
            controller.send_signal(signal.SIGINT)
            controller.wait(DEADLINE)
        finally:
            controller.kill()
            controller.wait()
    by_stamp = {
        message.header.stamp.sec * 10**9 + message.header.stamp.nanosec: message.position[0]
        for message in states  # one may be published twice
    }
    return [by_stamp[time] for time in sorted(by_stamp)][:length]


def test_it_reaches_its_goal_with_the_same_motion_each_time(peer):
    first = positions(peer, LENGTH)
    assert len(first) == LENGTH
    np.testing.assert_allclose(first[-100:], 0.06, atol=5e-6)
    assert positions(peer, AGAIN) == first[:AGAIN]


@pytest.mark.parametrize('kind', [signal.SIGINT, signal.SIGTERM])
def test_it_ends_with_its_result_and_without_a_traceback(peer, kind):
    commands = peer.collect(Float64, 'pressure_command')
    with Program('pam_sim', parameters={'time_mode': 'lockstep'}):
        controller = subprocess.Popen(
            [sys.executable, FILE], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        try:
            peer.more(commands)
            controller.send_signal(kind)
            output, _ = controller.communicate(timeout=DEADLINE)
        finally:
            controller.kill()
            controller.wait()
    assert output.startswith('last command: ')
    assert len(output.splitlines()) == 1
    assert controller.returncode == 0
