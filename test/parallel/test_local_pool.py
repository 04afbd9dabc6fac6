# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tasks in processes of this machine: results, failures, the end of all in the middle."""

import os
import signal
import subprocess
import sys
from contextlib import closing

import pytest

from pam_ros.errors import PamError
from pam_ros.parallel.local import LocalPool
from pam_ros.parallel.tasks import run_tasks
from support.tasks import (
    Task,
    all_replies,
    exists,
    expected,
    noted,
    refuse,
    wait_until,
    work,
)

KINDS = ('good', 'raises', 'kills once', 'good', 'kills', 'refuses', 'good')


@pytest.mark.parametrize('processes', [1, 3])
def test_each_task_has_a_result_or_a_reason(tmp_path, processes, capfd):
    tasks = [Task(tmp_path, number, kind) for number, kind in enumerate(KINDS)]
    assert all_replies(LocalPool(processes), tasks) == expected(tasks)
    assert noted(tmp_path, 'begun') == {0: 1, 1: 1, 2: 2, 3: 1, 4: 3, 5: 1, 6: 1}
    # Where an error of the program was is printed; a sentence for users is enough by itself.
    errors = capfd.readouterr().err
    assert errors.count('Traceback') == 1
    assert 'RuntimeError: the task is wrong' in errors


def test_tasks_run_side_by_side(tmp_path):
    tasks = [Task(tmp_path, number, seconds=1.0) for number in range(2)]
    running = run_tasks(work, tasks, LocalPool(2))
    next(running)
    assert noted(tmp_path, 'begun') == {0: 1, 1: 1}
    assert len(list(running)) == 1


def test_no_task_runs_in_a_process_that_cannot_be_prepared(tmp_path):
    with pytest.raises(PamError, match='no domain is free'):
        all_replies(LocalPool(2), [Task(tmp_path, 0)], refuse)
    assert not noted(tmp_path, 'begun')


def test_the_end_of_the_iterator_interrupts_what_runs(tmp_path):
    tasks = [Task(tmp_path, 0), *(Task(tmp_path, k, seconds=600.0) for k in (1, 2, 3))]
    with closing(run_tasks(work, tasks, LocalPool(2))) as running:
        assert next(running)[0] == 0
        wait_until(lambda: len(noted(tmp_path, 'begun')) == 3)
    assert noted(tmp_path, 'interrupted') == {1: 1, 2: 1}
    assert not noted(tmp_path, 'begun')[3]


PROGRAM = """
import sys
from pathlib import Path
from pam_ros.parallel.local import LocalPool
from support.tasks import Task, all_replies
all_replies(LocalPool(1), [Task(Path(sys.argv[1]), 0, seconds=600.0)])
"""


def test_a_task_does_not_outlive_a_program_that_is_killed(tmp_path):
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(filter(None, sys.path))}
    program = subprocess.Popen([sys.executable, '-c', PROGRAM, tmp_path], env=environment)
    wait_until(lambda: noted(tmp_path, 'begun'))
    tasks = [
        int(line)
        for line in subprocess.check_output(
            ['ps', '--ppid', str(program.pid), '-o', 'pid='], text=True
        ).split()
    ]
    program.send_signal(signal.SIGKILL)
    program.wait()
    wait_until(lambda: noted(tmp_path, 'interrupted') == {0: 1})
    wait_until(lambda: not any(map(exists, tasks)))
    assert len(tasks) == 1
