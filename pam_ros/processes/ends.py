# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Signals that request the end of a program, and the end of one that hangs while it ends.

If a controller ends without venting, the muscle stays under pressure; if a recorder does not end
properly, data that were not written are lost. A terminal that is closed therefore requests a
proper end, as Ctrl-C does.
"""

import faulthandler
import os
import signal
from collections.abc import Callable
from types import FrameType

ENDS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
# These stay ignored if they are ignored at the start: nohup does that, and shells do it for
# programs in the background.
MAY_BE_IGNORED = (signal.SIGHUP, signal.SIGQUIT)

ERRORS = 2  # the file descriptor of standard error


def on_end(handler: Callable[[int, FrameType | None], None]) -> None:
    """Call *handler*(signal, frame) for each signal that requests the end."""
    terminals = [output for output in (1, 2) if os.isatty(output)]

    def take(kind: int, frame: FrameType | None) -> None:
        if kind == signal.SIGHUP:
            # The terminal is closed: printing at the end would cause an error.
            nothing = os.open(os.devnull, os.O_WRONLY)
            for output in terminals:
                os.dup2(nothing, output)
            os.close(nothing)
        handler(kind, frame)

    for kind in ENDS:
        if kind in MAY_BE_IGNORED and signal.getsignal(kind) == signal.SIG_IGN:
            continue
        signal.signal(kind, take)


def ignore_ends() -> None:
    """Ignore these signals from now on, since the program ends already.

    Python restores the default handlers before it has ended. A second signal would then end the
    program by this signal instead of with its exit code.
    """
    for kind in ENDS:
        signal.signal(kind, signal.SIG_IGN)


def end_within(seconds: float) -> None:
    """End the process with exit code 1 if it still runs after so many *seconds*.

    It then prints the Python calls that have not returned. This works while a library in C waits
    for ever, which no handler of a signal in Python does.
    """
    faulthandler.dump_traceback_later(seconds, exit=True, file=ERRORS)
