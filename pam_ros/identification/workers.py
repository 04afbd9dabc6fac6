# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The threads in which simulations run in parallel."""

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from typing import Any, TypeVar

T = TypeVar('T')
# Simulations run in parallel; the rest of a fit, a third of its time, does not: more threads would
# wait for each other.
MOST_THREADS = 4
PAUSE = 0.5  # s between two updates while the caller waits


def thread_count() -> int:
    """Return how many threads an identification uses on this machine."""
    return min(os.cpu_count() or 1, MOST_THREADS)


class Workers(ThreadPoolExecutor):
    """Threads whose ``map`` waits for all of its calls, also if one of them fails.

    While it waits, it calls *update* from the thread of its caller.
    """

    def __init__(self, update: Callable[[], object]) -> None:
        """Prepare as many threads as :func:`thread_count` returns."""
        super().__init__(thread_count())
        self._update = update

    def map(
        self,
        fn: Callable[..., T],
        *iterables: Iterable[Any],
        timeout: float | None = None,
        chunksize: int = 1,
    ) -> Iterator[T]:
        """Return fn(*arguments) for each of the arguments, in their order.

        If a call raises, those that have not begun are left out, and the exception is raised after
        those that have begun have ended: nothing then continues in the background.
        """
        futures = [self.submit(fn, *given) for given in zip(*iterables, strict=False)]
        try:
            pending = set(futures)
            while pending:
                done, pending = wait(pending, PAUSE, FIRST_EXCEPTION)
                if any(future.exception() is not None for future in done):
                    break
                self._update()
        finally:
            for future in futures:
                future.cancel()
        wait(futures)
        return iter([future.result() for future in futures])
