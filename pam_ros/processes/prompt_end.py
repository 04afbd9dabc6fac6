# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C while a library in C works, such as the compiler of the kernels.

Python calls the handlers of signals between its own instructions only. The compiler needs up to
ten seconds for one call, in which a program would ignore Ctrl-C.
"""

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from threading import Event, Thread

from pam_ros.processes.ends import ENDS

GRACE = 0.5  # s in which a program can end by itself after a signal


@contextmanager
def end_promptly(
    code: int | None = None,
    sentence: str = '',
    leaves_first: Callable[[], bool] = lambda: False,
) -> Iterator[None]:
    """End the process within 0.5 s of a signal that requests the end.

    The handler of the signal can end the context before that; otherwise the process ends without
    any clean-up, after *sentence* on stderr, with the exit *code*; None stands for 128 and the
    number of the signal, as in a shell. So nothing in the context may leave half-written
    files or a muscle under pressure. numba's files on disk are complete at any time. Only signals
    with a handler in Python count. If *leaves_first* returns true at the first signal, the process
    ends so only at the second one: the handler takes its time to end the work. Must be called from
    the main thread.
    """
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    is_over = Event()
    watching = (reader, is_over, code, sentence, leaves_first)
    Thread(target=_watch, args=watching, daemon=True).start()
    before = signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
    try:
        yield
    finally:
        is_over.set()
        signal.set_wakeup_fd(before)
        os.close(writer)  # the thread ends


def _watch(
    reader: int,
    is_over: Event,
    code: int | None,
    sentence: str,
    leaves_first: Callable[[], bool],
) -> None:
    """Read the numbers of signals from *reader*, to which Python writes them at once."""
    with open(reader, 'rb', buffering=0) as signals:
        is_first = True
        while number := signals.read(1):
            if number[0] not in ENDS:
                continue
            is_left, is_first = is_first and leaves_first(), False
            if not is_left and not is_over.wait(GRACE):
                if sentence:
                    print(sentence, file=sys.stderr)
                for output in (sys.stdout, sys.stderr):
                    with suppress(OSError, ValueError):
                        output.flush()
                os._exit(128 + number[0] if code is None else code)
