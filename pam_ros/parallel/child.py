# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The process that runs tasks for a ``Slot``, one after another.

``python -m pam_ros.parallel.child NUMBER`` reads calls from the socket with this descriptor. If
the other end closes, for whatever reason, the task that runs is interrupted as by Ctrl-C, so that
processes which it has started are ended as well.
"""

import os
import pickle
import signal
import sys
import traceback
from multiprocessing.connection import Connection
from queue import SimpleQueue
from threading import Thread
from typing import Any

from pam_ros.errors import PamError
from pam_ros.parallel.tasks import Failure
from pam_ros.processes.ends import ignore_ends
from pam_ros.processes.interrupts import raise_on_signal

INTERRUPTED = 130


def main() -> None:
    """Run calls until the other end of the socket closes, or a signal requests the end."""
    raise_on_signal()
    calls: SimpleQueue[bytes] = SimpleQueue()
    pipe: Connection[Any, Any] = Connection(int(sys.argv[1]))
    try:
        Thread(target=_receive, args=(pipe, calls), daemon=True).start()
        if sentence := _prepared(calls.get()):
            pipe.send((False, pickle.dumps(sentence)))
            return
        while True:
            pipe.send((True, _reply(calls.get())))
    except (KeyboardInterrupt, BrokenPipeError):
        sys.exit(INTERRUPTED)
    finally:
        ignore_ends()


def _receive(pipe: 'Connection[Any, Any]', calls: 'SimpleQueue[bytes]') -> None:
    try:
        while True:
            calls.put(pipe.recv_bytes())
    except (EOFError, OSError):
        os.kill(os.getpid(), signal.SIGINT)


def _prepared(first: bytes) -> str:
    """Take over the path of modules, and call what prepares the process.

    *first* are both, pickled. Returns the sentence of a PamError, '' if there is none.
    """
    path, prepare = pickle.loads(first)
    sys.path[:] = path
    try:
        pickle.loads(prepare)()
    except PamError as error:
        return str(error)
    return ''


def _reply(call: bytes) -> bytes:
    """Return the result of a call, pickled; a Failure if it raises an exception."""
    result: Any
    try:
        function, task = pickle.loads(call)
        result = function(task)
    except PamError as error:
        result = Failure(str(error))
    except OSError as error:  # such as a full disk, which is no fault of the program
        result = Failure(f'{type(error).__name__}: {error}')
    except Exception as error:
        traceback.print_exc()  # where it happened is known nowhere else
        result = Failure(f'{type(error).__name__}: {error}')
    return pickle.dumps(result)


if __name__ == '__main__':
    main()
