# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The signals that ask a program to end, and the end of one that hangs while it ends.

A muscle stays under pressure when its controller ends without venting, and a recording loses what
was not written: a terminal that is closed asks for a proper end as Ctrl-C does.
"""

import faulthandler
import os
import signal
from collections.abc import Callable
from types import FrameType

ENDS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
# Kept ignored where they are at the start: nohup asks for that, and shells do in the background.
MAY_BE_IGNORED = (signal.SIGHUP, signal.SIGQUIT)

ERRORS = 2  # the file descriptor of standard error


def on_end(handler: Callable[[int, FrameType | None], None]) -> None:
    """Call *handler*(signal, frame) for each signal that asks for the end."""
    terminals = [output for output in (1, 2) if os.isatty(output)]

    def take(kind: int, frame: FrameType | None) -> None:
        if kind == signal.SIGHUP:
            # Their terminal is closed: what is printed at the end would be an error.
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
    """Ignore these signals from now on: the program ends already.

    Python sets its own handlers back to the default before it has ended, so that a second
    signal would end it by this signal instead of with its exit code.
    """
    for kind in ENDS:
        signal.signal(kind, signal.SIG_IGN)


def end_within(seconds: float) -> None:
    """End the process with exit code 1 if it still runs after so many *seconds*.

    It then prints the Python calls that have not returned. This works while a library in C waits
    for ever, which no handler of a signal in Python does.
    """
    faulthandler.dump_traceback_later(seconds, exit=True, file=ERRORS)
