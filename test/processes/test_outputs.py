# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Whatever becomes of what a program prints, the program does its work and ends with its code."""

import os
import subprocess
import sys

import pytest

PROGRAM = """
import sys
from pathlib import Path
from pam_ros.processes.outputs import guard_outputs
guard_outputs()
for _ in range(3):
    print('position in \\xb5m', flush={flush})
    print('progress', file=sys.stderr)
with Path(sys.argv[1]).open('w', encoding='utf-8') as work:
    print(work.fileno() > 2, file=work)
sys.exit(3)
"""
TEXT = 'position in µm\n'


def run(work, redirection='', flush=True, **environment):
    """Run the program in a shell; return (exit code, stdout, stderr) and check its work."""
    done = subprocess.run(
        ['sh', '-c', f'"$0" -c "$1" "$2" {redirection}', sys.executable,
         PROGRAM.format(flush=flush), str(work)],
        capture_output=True,
        env={**os.environ, 'PYTHONIOENCODING': '', **environment},
        check=False,
    )  # fmt: skip
    assert work.read_text(encoding='utf-8') == 'True\n'
    return done.returncode, done.stdout.decode(), done.stderr.decode()


@pytest.fixture
def work(tmp_path):
    return tmp_path / 'work.txt'


@pytest.mark.parametrize('unbuffered', ['', '1'])
def test_what_can_be_printed_is_printed(work, unbuffered):
    found = run(work, PYTHONUNBUFFERED=unbuffered, PYTHONUTF8='1')
    assert found == (3, 3 * TEXT, 3 * 'progress\n')


@pytest.mark.parametrize('unbuffered', ['', '1'])
@pytest.mark.parametrize('flush', [True, False])
def test_a_full_disk_is_one_sentence(work, flush, unbuffered):
    code, out, errors = run(work, '>/dev/full', flush, PYTHONUNBUFFERED=unbuffered)
    assert (code, out) == (3, '')
    assert errors.count('standard output cannot be written: No space left on device') == 1
    assert len(errors.splitlines()) == 4


@pytest.mark.parametrize(
    ('redirection', 'errors'),
    [('>&-', 3), ('2>&-', 0), ('2>/dev/full', 0), ('<&- >&- 2>&-', 0), ('>/dev/full 2>&1', 0)],
)
def test_closed_outputs_are_passed_over(work, redirection, errors):
    code, _, written = run(work, redirection)
    assert code == 3
    assert written == errors * 'progress\n'


@pytest.mark.parametrize('flush', [True, False])
def test_a_reader_that_leaves_is_passed_over(work, flush):
    reading, writing = os.pipe()
    os.close(reading)
    program = [sys.executable, '-c', PROGRAM.format(flush=flush), str(work)]
    done = subprocess.run(program, stdout=writing, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writing)
    assert done.returncode == 3
    assert done.stderr == 3 * 'progress\n'
    assert work.read_text(encoding='utf-8') == 'True\n'


def test_letters_that_the_locale_lacks_are_escaped(work):
    code, out, _ = run(work, LC_ALL='C', PYTHONUTF8='0', PYTHONCOERCECLOCALE='0')
    assert (code, out) == (3, 3 * 'position in \\xb5m\n')
