# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Standard outputs that do not end a program if they are closed, full or lack a character.

The task of a program, such as a report or a muscle under pressure, does not depend on who reads
its output. After ``| head -1``, or if the disk of its log is full, the program continues.
"""

import errno
import io
import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any


class _Output(io.FileIO):
    """A file descriptor that discards all data from the first error on."""

    def write(self, data: Any, /) -> int:
        """Write *data*; return how many bytes were taken."""
        try:
            return super().write(data)
        except OSError as error:
            number = self.fileno()
            nothing = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nothing, number)
            os.close(nothing)
            # An output that is closed on purpose, as by head, needs no message.
            if number == 1 and error.errno != errno.EPIPE:
                program = Path(sys.argv[0]).stem
                sentence = f'{program}: standard output cannot be written: {error.strerror}\n'
                with suppress(OSError):
                    os.write(2, sentence.encode('utf-8', 'backslashreplace'))
            return memoryview(data).nbytes


def guard_outputs() -> None:
    """Let no error of standard output or standard error reach the program.

    A character that the encoding lacks, such as a non-ASCII one in the locale C, is printed as its
    escape sequence.
    """
    _open_closed()
    for number, name in ((1, 'stdout'), (2, 'stderr')):
        stream = getattr(sys, name)
        if stream is None:
            nowhere = Path(os.devnull).open('w', encoding='utf-8')  # noqa: SIM115
            setattr(sys, name, nowhere)
        elif isinstance(stream, io.TextIOWrapper) and stream is getattr(sys, f'__{name}__'):
            stream.flush()
            setattr(sys, name, _guarded(number, stream))


def _open_closed() -> None:
    """Open descriptors 0 to 2 if they are closed: else the next files would get their numbers."""
    while (number := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(number, True)
    os.close(number)


def _guarded(number: int, stream: io.TextIOWrapper) -> io.TextIOWrapper:
    raw = _Output(number, 'w', closefd=False)
    return io.TextIOWrapper(
        # Python has no buffer if PYTHONUNBUFFERED is set.
        raw if stream.write_through else io.BufferedWriter(raw),
        encoding=stream.encoding,
        errors='backslashreplace',
        line_buffering=stream.line_buffering,
        write_through=stream.write_through,
    )
