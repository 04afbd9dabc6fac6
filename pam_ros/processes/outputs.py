# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Standard outputs that cannot end a program: closed, full, or without a letter for a name.

What a program is for, a report or a muscle under pressure, does not depend on who reads what it
prints: after ``| head -1``, or with the disk of its log full, it goes on as if nobody looked.
"""

import errno
import io
import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any


class _Output(io.FileIO):
    """A file descriptor that leads to nothing from the first error on."""

    def write(self, data: Any, /) -> int:
        """Write *data*; return how many bytes were taken."""
        try:
            return super().write(data)
        except OSError as error:
            number = self.fileno()
            nothing = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nothing, number)
            os.close(nothing)
            # One that is closed on purpose, as by head, is nothing to complain about.
            if number == 1 and error.errno != errno.EPIPE:
                program = Path(sys.argv[0]).stem
                sentence = f'{program}: standard output cannot be written: {error.strerror}\n'
                with suppress(OSError):
                    os.write(2, sentence.encode('utf-8', 'backslashreplace'))
            return memoryview(data).nbytes


def guard_outputs() -> None:
    """Let no error of standard output or standard error reach the program.

    A letter that the encoding lacks, as any but ASCII in the locale C, is printed as its escape.
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
    """Open descriptors 0 to 2 where they are closed: else the next file would get their number."""
    while (number := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(number, True)
    os.close(number)


def _guarded(number: int, stream: io.TextIOWrapper) -> io.TextIOWrapper:
    raw = _Output(number, 'w', closefd=False)
    return io.TextIOWrapper(
        # Python has no buffer where it is told so (PYTHONUNBUFFERED).
        raw if stream.write_through else io.BufferedWriter(raw),
        encoding=stream.encoding,
        errors='backslashreplace',
        line_buffering=stream.line_buffering,
        write_through=stream.write_through,
    )
