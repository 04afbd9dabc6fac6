# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tasks that run side by side, and what becomes of one that fails by itself.

A task is one call of a function of a module. It runs in a process of its own, so that neither a
crash nor a leak of it reaches another one. The result does not depend on where it ran.
"""

import pickle
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from typing import Protocol, TypeVar

T = TypeVar('T')
R = TypeVar('R')

ATTEMPTS = 3  # of a task whose process is killed
Prepare = Callable[[], None]
Replies = Generator[tuple[int, bytes], None, None]  # by the numbers of the tasks, pickled


@dataclass(frozen=True)
class Failure:
    """A task that gave no result; the *reason* is a sentence."""

    reason: str


class Pool(Protocol):
    """Processes that take tasks."""

    def run(self, calls: Sequence[bytes], prepare: Prepare) -> Replies:
        """Yield the number of each of the *calls* once, with its reply, as they end.

        *prepare* is called once in each process before its first task.
        """
        ...


def _nothing() -> None:
    """Prepare nothing."""


def run_tasks(
    function: Callable[[T], R], tasks: Sequence[T], pool: Pool, prepare: Prepare = _nothing
) -> Generator[tuple[int, R | Failure], None, None]:
    """Yield the number of each task once, and function(task) or why there is none, as they end.

    *function* and *prepare* must be functions of modules, or partial ones, and tasks and results
    must be picklable. A task that raises an exception is a Failure. One whose process is killed
    is repeated; the third time it is a Failure, too. Closing the generator ends all processes.
    Raises PamError if *prepare* does, or if the processes cannot be reached.
    """
    calls = [pickle.dumps((function, task)) for task in tasks]
    with closing(pool.run(calls, prepare)) as replies:
        for number, reply in replies:
            yield number, pickle.loads(reply)
