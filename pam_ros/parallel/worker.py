# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a worker of a Dask cluster runs: each of its threads has a process for tasks."""

import pickle
import threading
from typing import NamedTuple

from pam_ros.errors import PamError
from pam_ros.parallel.slot import Slot
from pam_ros.parallel.sources import digest_of_sources
from pam_ros.parallel.tasks import Prepare


class Session(NamedTuple):
    """The tasks of one program; ``digest`` is that of its sources."""

    name: str
    digest: str
    prepare: Prepare


class _Worker:
    """The processes for tasks of this worker, by session and thread, and sessions that ended."""

    slots: dict[tuple[str, int], Slot] = {}  # noqa: RUF012 there is one worker in a process
    ended: set[str] = set()  # noqa: RUF012
    lock = threading.Lock()


def reply_on_worker(call: bytes, session: bytes) -> bytes:
    """Return the reply to a *call* of the pickled *session*; see ``Slot.call``.

    Raises PamError if this worker has other sources than the program.
    """
    own: Session = pickle.loads(session)
    if own.digest != digest_of_sources():
        raise PamError(
            f'a worker of Dask has another version of pam_ros (sources {digest_of_sources()}) '
            f'than this machine (sources {own.digest}): install the same on all'
        )
    key = own.name, threading.get_ident()
    with _Worker.lock:
        if own.name in _Worker.ended:
            raise InterruptedError
        slot = _Worker.slots.setdefault(key, Slot(own.prepare))
    return slot.call(call)


def end_session(name: str) -> None:
    """Interrupt the tasks of a session, whose processes then end, and accept no others of it."""
    with _Worker.lock:
        _Worker.ended.add(name)
        keys = [key for key in _Worker.slots if key[0] == name]
        slots = [_Worker.slots.pop(key) for key in keys]
    for slot in slots:
        slot.interrupt()
        # Not in the thread of this call, in which the worker talks to its scheduler.
        threading.Thread(target=slot.wait, daemon=True).start()
