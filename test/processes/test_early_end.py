# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Signals to a program whose work can end early, in processes of their own."""

import subprocess
import sys

import pytest

PROGRAM = """
import hashlib, os, signal, sys, time
from pam_ros.processes.early_end import EarlyEnd
from pam_ros.processes.prompt_end import end_promptly

def send(kind):
    os.kill(os.getpid(), kind)

stop = EarlyEnd()
with stop.on_signals(), end_promptly(sentence='killed', leaves_first=lambda: stop.has_result):
    {work}
print('is over', stop.is_requested)
sys.exit(stop.code)
"""
IN_C = "hashlib.pbkdf2_hmac('sha256', b'', b'', 2**31 - 1)"


def run(work):
    """Return the exit code, the last line of standard error, and standard output."""
    done = subprocess.run(
        [sys.executable, '-c', PROGRAM.format(work=work)],
        capture_output=True,
        text=True,
        check=False,
    )
    return done.returncode, done.stderr.strip().split('\n')[-1], done.stdout.strip()


@pytest.mark.parametrize(('kind', 'code'), [('SIGINT', 130), ('SIGTERM', 143)])
def test_the_first_signal_requests_the_end_of_a_work_that_has_a_result(kind, code):
    """It takes as long as it needs, also longer than a program that must end promptly."""
    work = f'print(stop()); send(signal.{kind}); print(stop()); time.sleep(0.8)'
    assert run(work) == (code, '', 'False\nTrue\nis over True')


def test_before_there_is_a_result_the_first_signal_ends_the_program():
    assert run('send(signal.SIGINT)')[1:] == ('KeyboardInterrupt', '')
    assert run('send(signal.SIGTERM)') == (143, '', '')


@pytest.mark.parametrize(('kind', 'code'), [('SIGINT', 130), ('SIGTERM', 143)])
def test_the_second_signal_ends_the_program_at_once_also_in_c(kind, code):
    work = f'stop(); send(signal.SIGINT); send(signal.{kind}); print("continues")'
    last = {'SIGINT': 'KeyboardInterrupt', 'SIGTERM': ''}[kind]
    assert run(work)[1:] == (last, '')
    sent_later = (
        'stop(); send(signal.SIGINT); '
        f"os.system(f'(sleep 0.3; kill -{kind[3:]} {{os.getpid()}}) &'); {IN_C}"
    )
    assert run(sent_later) == (code, 'killed', '')


def test_a_signal_that_is_ignored_stays_ignored_and_handlers_are_put_back():
    ignored = """
import os, signal
from pam_ros.processes.early_end import EarlyEnd
signal.signal(signal.SIGINT, signal.SIG_IGN)
before = signal.getsignal(signal.SIGTERM)
stop = EarlyEnd()
with stop.on_signals():
    stop()
    os.kill(os.getpid(), signal.SIGINT)
print(stop.is_requested, signal.getsignal(signal.SIGTERM) == before)
"""
    done = subprocess.run(
        [sys.executable, '-c', ignored], capture_output=True, text=True, check=False
    )
    assert done.stdout.split() == ['False', 'True'], done.stderr
