# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A place for one task at a time, in a process of its own that is replaced if it is killed."""

import os
import pickle
import socket
import subprocess
import sys
from contextlib import suppress
from multiprocessing.connection import Connection
from threading import Lock
from typing import Any

from pam_ros.errors import PamError
from pam_ros.parallel.tasks import ATTEMPTS, Failure, Prepare

# s within which an interrupted process must end; its task may have to end processes of its own.
PATIENCE = 15.0


class Slot:
    """A process that runs one task after another.

    ``multiprocessing`` cannot start it, because a worker of Dask may not start processes by it.
    """

    def __init__(self, prepare: Prepare) -> None:
        """Call *prepare* in each process before its first task; none is started before that."""
        self._prepare = pickle.dumps(prepare)
        self._process: subprocess.Popen[bytes] | None = None
        self._pipe: Connection[Any, Any] | None = None
        self._lock = Lock()
        self._is_ended = False

    def call(self, call: bytes) -> bytes:
        """Return the reply to a *call*, a pickled pair of a function and its task.

        Raises PamError if the process cannot be prepared, InterruptedError if the slot was ended
        meanwhile.
        """
        code = 0
        for _ in range(ATTEMPTS):
            pipe = self._pipe or self._start()
            try:
                pipe.send_bytes(call)
                is_prepared, reply = pipe.recv()
            except (EOFError, OSError):
                code = self._lose()
                continue
            if not is_prepared:
                self._lose()
                raise PamError(str(pickle.loads(reply)))
            return bytes(reply)
        how = f'by signal {-code}' if code < 0 else f'with exit code {code}'
        return pickle.dumps(Failure(f'its process ended {how}, {ATTEMPTS} times'))

    def interrupt(self) -> None:
        """Interrupt the process, and accept no other call; one that waits for a reply raises."""
        with self._lock:
            self._is_ended = True
            if self._pipe is not None:
                # To close it would not wake up the thread that waits for a reply.
                with suppress(OSError), socket.socket(fileno=os.dup(self._pipe.fileno())) as end:
                    end.shutdown(socket.SHUT_RDWR)

    def wait(self) -> None:
        """Wait for the end of an interrupted process; kill it if it does not end."""
        if self._process is None:
            return
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _start(self) -> 'Connection[Any, Any]':
        """Start a process, and return the pipe to it."""
        here, there = socket.socketpair()
        with there, self._lock:
            if self._is_ended:
                here.close()
                raise InterruptedError
            command = [sys.executable, '-m', 'pam_ros.parallel.child', str(there.fileno())]
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                pass_fds=[there.fileno()],
                start_new_session=True,  # a signal of the terminal reaches it by interrupt()
            )
            self._pipe = Connection(here.detach())
        with suppress(OSError):  # then the first call fails as well
            self._pipe.send_bytes(pickle.dumps((sys.path, self._prepare)))
        return self._pipe

    def _lose(self) -> int:
        """Close what is left of a process that does not answer, and return its exit code."""
        with self._lock:
            if self._pipe is not None:
                self._pipe.close()
            self._pipe = None
            if self._is_ended:
                raise InterruptedError
        return 0 if self._process is None else self._process.wait()
