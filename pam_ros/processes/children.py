# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Programs of this package as separate processes."""

import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from types import TracebackType
from typing import Any

PATIENCE = 60.0  # s within which a program must end after Ctrl-C


class Program:
    """A program ``pam_ros.cli.<name>``, in a process group of its own.

    As a context manager it stops the program at the end: by Ctrl-C, or by SIGKILL if the program
    does not end then.
    """

    def __init__(
        self, name: str, *arguments: str, parameters: Mapping[str, Any] | None = None
    ) -> None:
        """Start it with these ROS arguments and parameters."""
        for key, value in (parameters or {}).items():
            arguments += ('-p', f'{key}:={_text(value)}')
        self.name = name
        self._out = tempfile.TemporaryFile('w+')  # noqa: SIM115 closed at the end of the context
        self.process = self._start(f'pam_ros.cli.{name}', ['--ros-args', *arguments])

    def _start(self, module: str, arguments: list[str]) -> 'subprocess.Popen[bytes]':
        return subprocess.Popen(
            [sys.executable, '-m', module, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=self._out,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )

    def __enter__(self) -> 'Program':
        """Return the running program."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Stop it."""
        self.stop()
        self._out.close()

    @property
    def is_running(self) -> bool:
        """Whether it has not ended yet."""
        return self.process.poll() is None

    def interrupt(self, kind: int = signal.SIGINT, times: int = 1) -> None:
        """Send a signal to its process group, as a terminal or launch does."""
        for _ in range(times):
            os.killpg(self.process.pid, kind)

    def stop(self) -> int:
        """Stop it by Ctrl-C, if it still runs, and return its exit code."""
        if self.is_running:
            self.interrupt()
        try:
            return self.wait()
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise

    def wait(self) -> int:
        """Wait for its end and return its exit code."""
        return self.process.wait(PATIENCE)

    @property
    def output(self) -> str:
        """What it has printed so far, both streams."""
        self._out.seek(0)
        return self._out.read()


def _text(value: Any) -> str:
    if isinstance(value, list | tuple):
        return '[' + ', '.join(map(str, value)) + ']'
    return str(value).lower() if isinstance(value, bool) else str(value)
