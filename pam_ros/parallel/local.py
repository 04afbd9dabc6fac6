# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tasks in several processes of this machine."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from queue import SimpleQueue

from pam_ros.parallel.slot import Slot
from pam_ros.parallel.tasks import Prepare, Replies


class LocalPool:
    """So many processes of this machine."""

    def __init__(self, processes: int) -> None:
        """Run at most this number of tasks at once."""
        self._processes = processes

    def run(self, calls: Sequence[bytes], prepare: Prepare) -> Replies:
        """Yield the number of each of the *calls*, with its reply, as they end; see ``Pool``."""
        slots = [Slot(prepare) for _ in range(min(self._processes, len(calls)))]
        free: SimpleQueue[Slot] = SimpleQueue()
        for slot in slots:
            free.put(slot)

        def reply(call: bytes) -> bytes:
            slot = free.get()
            try:
                return slot.call(call)
            finally:
                free.put(slot)

        with ThreadPoolExecutor(len(slots) or 1) as threads:
            try:
                numbers = {threads.submit(reply, call): k for k, call in enumerate(calls)}
                for future in as_completed(numbers):
                    yield numbers.pop(future), future.result()
            finally:
                threads.shutdown(wait=False, cancel_futures=True)
                for slot in slots:
                    slot.interrupt()
                for slot in slots:
                    slot.wait()
