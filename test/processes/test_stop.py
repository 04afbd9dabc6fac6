# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Signals in processes of their own: taken note of, or raised once."""

import subprocess
import sys

import pytest

NOTED = """
import os, signal
from pam_ros.processes.stop import StopRequest
stop = StopRequest()
print(stop.is_made)
for _ in range(2):
    os.kill(os.getpid(), signal.{kind})
print(stop.is_made)
"""
LAST = """
import os, signal
from pam_ros.processes.ends import ignore_ends
from pam_ros.processes.stop import StopRequest

class Last:
    def __del__(self, kill=os.kill, pid=os.getpid(), kind=signal.{kind}):
        kill(pid, kind)

import sys
StopRequest()
sys.last = Last()  # goes when the interpreter ends, behind all handlers of Python
ignore_ends()
print('ended')
"""
IGNORED = """
import os, signal
from pam_ros.processes.stop import StopRequest
signal.signal(signal.{kind}, signal.SIG_IGN)
stop = StopRequest()
os.kill(os.getpid(), signal.{kind})
print(stop.is_made)
"""
RAISED = """
import os, signal
from pam_ros.processes.interrupts import raise_on_signal, held_back
raise_on_signal()
try:
    with held_back():
        os.kill(os.getpid(), signal.{kind})
        print('held')
except KeyboardInterrupt:
    print('raised')
os.kill(os.getpid(), signal.{kind})
print('once')
"""
LIMITED = """
import time
from pam_ros.processes.ends import end_within

def wait_for_the_middleware():
    time.sleep({duration})

end_within({limit})
wait_for_the_middleware()
"""


@pytest.mark.parametrize('kind', ['SIGINT', 'SIGTERM', 'SIGHUP', 'SIGQUIT'])
@pytest.mark.parametrize(
    ('code', 'printed'),
    [(NOTED, ['False', 'True']), (RAISED, ['held', 'raised', 'once'])],
    ids=['noted', 'raised'],
)
def test_a_signal_that_comes_again_does_no_harm(code, printed, kind):
    check(code, printed, kind)


@pytest.mark.parametrize('kind', ['SIGINT', 'SIGTERM', 'SIGHUP', 'SIGQUIT'])
def test_nor_does_one_when_the_interpreter_ends(kind):
    check(LAST, ['ended'], kind)


@pytest.mark.parametrize('kind', ['SIGHUP', 'SIGQUIT'])
def test_a_signal_that_nohup_or_a_shell_has_ignored_stays_ignored(kind):
    check(IGNORED, ['False'], kind)


def check(code, printed, kind):
    done = subprocess.run(
        [sys.executable, '-c', code.format(kind=kind)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == printed


@pytest.mark.parametrize(('limit', 'code'), [(0.2, 1), (600.0, 0)])
def test_the_end_of_a_program_has_a_limit(limit, code):
    done = subprocess.run(
        [sys.executable, '-c', LIMITED.format(limit=limit, duration=0.0 if code == 0 else 600.0)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == code
    assert ('in wait_for_the_middleware' in done.stderr) == (code == 1)
