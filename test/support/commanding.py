# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_command`` as a process that ends by itself."""

from support.ends import End
from support.harness import Program

NOTE = 'pam_command: waits up to '  # on a slow machine, after a second
WAIT = ('--wait', '60')  # s; only a program that is broken waits so long


def command(*words, ros=(), wait=WAIT, peer=None):
    """Run ``pam_command`` with *words* and the arguments *ros* for ROS; return how it ended.

    Meanwhile *peer* answers, if it is given: it may be asked for its parameters.
    """
    with Program('pam_command', *ros, '--', *words, *wait) as program:
        if peer is not None:
            peer.until(lambda: not program.is_running, 'the end of pam_command')
        code = program.wait()
        return End(code, said(program))


def said(program):
    """Return what ``pam_command`` has printed, without the notes that it waits."""
    lines = program.output.splitlines(keepends=True)
    return ''.join(line for line in lines if not line.startswith(NOTE))
