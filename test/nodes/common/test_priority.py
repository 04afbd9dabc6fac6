# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Loops that keep wall time run before other programs, where the system permits it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticArray

from support.harness import FreshProgram

pytestmark = pytest.mark.at_any_pace

PERMITTED = 'import os; os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(10))'


def is_permitted():
    """Say whether a child of ours may take a real-time priority: else the nodes may not."""
    return subprocess.run([sys.executable, '-c', PERMITTED], stderr=subprocess.DEVNULL,
                          check=False).returncode == 0  # fmt: skip


def policies(pid):
    """Return how many threads of a process run by real-time scheduling, and how many normally."""
    threads = [int(task.name) for task in Path(f'/proc/{pid}/task').iterdir()]
    found = [os.sched_getscheduler(thread) & ~os.SCHED_RESET_ON_FORK for thread in threads]
    return found.count(os.SCHED_FIFO), found.count(os.SCHED_OTHER)


@pytest.mark.parametrize('mode', ['real_time', 'scaled', 'lockstep'])
def test_only_the_loop_in_real_time_has_priority_and_logs_it(peer, mode):
    reports = peer.collect(DiagnosticArray, '/diagnostics')
    with FreshProgram('pam_sim', parameters={'time_mode': mode}) as sim:

        def scheduling():
            values = {v.key: v.value for m in reports for s in m.status for v in s.values}
            return values.get('scheduling')

        said = peer.until(scheduling, 'how it is scheduled')
        first, normal = policies(sim.process.pid)
    goes_first = mode == 'real_time' and is_permitted()
    assert said == ('SCHED_FIFO 10' if goes_first else 'normal')
    assert first == (1 if goes_first else 0)
    assert normal > 0
