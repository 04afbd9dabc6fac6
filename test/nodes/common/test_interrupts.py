# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A signal that comes while rclpy handles a message, in a process of its own."""

import subprocess
import sys

import pytest

pytestmark = [pytest.mark.at_any_pace, pytest.mark.usefixtures('domain')]

CLIENT = """
import os, signal, sys
from std_msgs.msg import Float64
from pam_ros.nodes.demo.client import Client
from pam_ros.processes.interrupts import raise_on_signal

class Lost:
    def __del__(self):
        for _ in range(2):
            os.kill(os.getpid(), signal.SIGTERM)
        len([])

raise_on_signal()
try:
    with Client() as client:
        client.node.create_subscription(Float64, 'here', lambda message: {act}, 10)
        client.publish(Float64(), 'here')
        client.work(1.0)
        print('worked')
        {last}
        client.work(1.0)
        print('worked')
except KeyboardInterrupt:
    print('interrupted')
"""
KILL = 'os.kill(os.getpid(), signal.SIGTERM)'


@pytest.mark.parametrize(
    ('act', 'last', 'printed'),
    [
        (KILL, 'pass', ['interrupted']),
        ('(Lost(), None)', 'pass', ['interrupted']),
        ('None', KILL, ['worked', 'interrupted']),
        ('None', 'Lost()', ['worked', 'interrupted']),
        ('None', 'pass', ['worked', 'worked']),
    ],
    ids=['callback', 'destructor', 'outside', 'destructor outside', 'none'],
)
def test_a_signal_comes_out_as_an_interrupt(act, last, printed):
    code = CLIENT.format(act=act, last=last)
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == printed
