# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The end of programs that a signal reaches within a library in C."""

import os
import signal
import subprocess
import sys

import pytest

# The hash stands for the compiler: one call in C, in which no handler is called.
PROGRAM = """
import hashlib, os, signal, time
from pam_ros.processes.prompt_end import end_promptly
from pam_ros.processes.stop import StopRequest

stop = StopRequest()
with end_promptly({arguments}):
    os.kill(os.getpid(), signal.{kind})
    hashlib.pbkdf2_hmac('sha256', b'', b'', {iterations})
time.sleep(1.0)
print('continues', stop.is_made)
"""
FOREVER = 2**31 - 1


def run(**given):
    code = PROGRAM.format(**given)
    return subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize(
    ('kind', 'arguments', 'code', 'sentence'),
    [
        ('SIGINT', '', 130, ''),
        ('SIGTERM', "sentence='stopped'", 143, 'stopped\n'),
        ('SIGTERM', '0', 0, ''),
    ],
)
def test_a_program_ends_although_no_handler_can_run(kind, arguments, code, sentence):
    done = run(kind=kind, arguments=arguments, iterations=FOREVER)
    assert (done.returncode, done.stdout, done.stderr) == (code, '', sentence)


def test_a_program_that_leaves_the_context_ends_by_itself():
    done = run(kind='SIGINT', arguments='', iterations=1)
    assert done.stdout.split() == ['continues', 'True'], done.stderr


@pytest.mark.slow
@pytest.mark.needs_numba
def test_the_program_that_compiles_all_can_be_stopped(tmp_path):
    environment = {**os.environ, 'NUMBA_CACHE_DIR': str(tmp_path)}
    program = subprocess.Popen(
        [sys.executable, '-m', 'pam_ros.rig.warm'],
        env=environment,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    while not list(tmp_path.rglob('*.nbi')):
        assert program.poll() is None
    os.killpg(program.pid, signal.SIGINT)
    assert (program.communicate()[1], program.returncode) == ('', 130)
