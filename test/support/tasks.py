# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tasks for tests of ``pam_ros.parallel``, which note in a folder what has happened to them."""

import os
import signal
from collections import Counter
from pathlib import Path
from time import monotonic, sleep
from typing import NamedTuple

import numpy as np

from pam_ros.errors import PamError
from pam_ros.parallel.tasks import Failure, run_tasks


class Task(NamedTuple):
    """A task with its number, and how it behaves."""

    folder: Path
    number: int
    kind: str = 'good'
    seconds: float = 0.0


def refuse() -> None:
    """Refuse to be prepared."""
    raise PamError('no domain is free')


def work(task: Task) -> tuple[int, bytes]:
    """Return the number and bytes that follow from it, or do what the kind says."""
    note(task, 'begun')
    try:
        sleep(task.seconds)
    except KeyboardInterrupt:
        note(task, 'interrupted')
        raise
    if task.kind == 'raises':
        raise RuntimeError('the task is wrong')
    if task.kind == 'refuses':
        raise PamError('mass = -1 kg is not allowed')
    if task.kind == 'kills' or (task.kind == 'kills once' and count(task, 'begun') == 1):
        os.kill(os.getpid(), signal.SIGKILL)
    note(task, 'ended')
    return task.number, np.random.default_rng(task.number).normal(size=10).tobytes()


def note(task: Task, what: str) -> None:
    """Note that something has happened to *task*."""
    with (task.folder / f'{what}.txt').open('a', encoding='ascii') as file:
        file.write(f'{task.number}\n')


def noted(folder: Path, what: str) -> 'Counter[int]':
    """Return how often something has happened, by task."""
    path = folder / f'{what}.txt'
    return (
        Counter(map(int, path.read_text(encoding='ascii').split())) if path.exists() else Counter()
    )


def count(task: Task, what: str) -> int:
    """Return how often something has happened to *task*."""
    return noted(task.folder, what)[task.number]


def all_replies(pool, tasks, *prepare):
    """Return the result of each task, which the pool must yield once."""
    found = {}
    for number, result in run_tasks(work, tasks, pool, *prepare):
        assert number not in found
        found[number] = result
    assert sorted(found) == list(range(len(tasks)))
    return [found[number] for number in range(len(tasks))]


def expected(tasks):
    """Return the results of these tasks where they run without a pool."""
    reasons = {
        'raises': 'RuntimeError: the task is wrong',
        'refuses': 'mass = -1 kg is not allowed',
        'kills': 'its process ended by signal 9, 3 times',
    }
    return [
        Failure(reasons[task.kind])
        if task.kind in reasons
        else (task.number, np.random.default_rng(task.number).normal(size=10).tobytes())
        for task in tasks
    ]


def wait_until(condition, seconds=60.0):
    """Wait until *condition* holds, and fail after so many seconds."""
    end = monotonic() + seconds
    while not condition():
        assert monotonic() < end
        sleep(0.02)


def exists(process: int) -> bool:
    """Say whether a process with this id runs; one that was not waited for does not."""
    try:
        state = Path(f'/proc/{process}/stat').read_text(encoding='utf-8').rpartition(')')[2]
    except OSError:
        return False
    return state.split()[0] != 'Z'
