# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A controller as a process, in a process group of its own, which is ended with the run."""

import ctypes
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from types import TracebackType

PATIENCE = 5.0  # s within which a controller must end after Ctrl-C, before it is killed
MOST_OUTPUT = 4000  # characters at the end of the output that are kept


_LIBC = ctypes.CDLL(None)
_PR_SET_PDEATHSIG = 1  # of prctl(2)


def _end_with_parent() -> None:
    """Let the kernel end this process if the one that started it is killed (Linux)."""
    if sys.platform == 'linux':
        _LIBC.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)


class ControllerProcess:
    """A running controller; as a context manager it ends it and all that it has started."""

    def __init__(self, command: Sequence[str], environment: Mapping[str, str]) -> None:
        """Start *command* with these variables of the *environment*, in addition to the own."""
        self._out = tempfile.TemporaryFile('w+b')  # noqa: SIM115 closed at the end of the context
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=self._out,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            preexec_fn=_end_with_parent,  # noqa: PLW1509 it makes one call of the system
            env={**os.environ, **environment},
        )

    def __enter__(self) -> 'ControllerProcess':
        """Return the running controller."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End it: by Ctrl-C, and after PATIENCE by SIGKILL."""
        with suppress(ProcessLookupError):  # all have ended
            os.killpg(self._process.pid, signal.SIGINT)
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(PATIENCE)
        with suppress(ProcessLookupError):  # what it has started may still run
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._out.close()

    @property
    def exit_code(self) -> int | None:
        """The exit code, negative after a signal; None while it runs."""
        return self._process.poll()

    @property
    def last_words(self) -> str:
        """The last line of its output that is not empty."""
        size = self._out.seek(0, os.SEEK_END)
        self._out.seek(max(size - MOST_OUTPUT, 0))
        text = self._out.read().decode('utf-8', 'replace')
        lines = (' '.join(line.split()) for line in reversed(text.splitlines()))
        return next(filter(None, lines), '')
