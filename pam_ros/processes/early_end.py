# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C in a program whose work can end early with a result: the first one ends the work.

The second one ends the program, and so does the first one as long as there is no result.
"""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

ENDS = (signal.SIGINT, signal.SIGTERM)


class EarlyEnd:
    """A request to end the work early with what it has found so far.

    It is a function without arguments that returns whether the work must end. The work calls it
    as soon as it has a first result, and often from then on: before, a signal ends the program.
    """

    def __init__(self) -> None:
        """Nothing is requested, and nothing is found yet."""
        self.has_result = False
        self.code = 0  # exit code of the program: 128 and the number of the signal, as in a shell

    def __call__(self) -> bool:
        """Return whether the work must end."""
        self.has_result = True
        return self.is_requested

    @property
    def is_requested(self) -> bool:
        """Whether a signal has requested the end."""
        return self.code != 0

    @contextmanager
    def on_signals(self) -> Iterator[None]:
        """Handle SIGINT and SIGTERM in the context; must be called from the main thread."""
        # Shells let programs in the background ignore Ctrl-C.
        kinds = [kind for kind in ENDS if signal.getsignal(kind) != signal.SIG_IGN]
        before = {kind: signal.signal(kind, self._take) for kind in kinds}
        try:
            yield
        finally:
            for kind, handler in before.items():
                signal.signal(kind, handler)

    def _take(self, kind: int, frame: FrameType | None) -> None:
        if self.has_result and not self.is_requested:
            self.code = 128 + kind
        elif kind == signal.SIGINT:
            raise KeyboardInterrupt
        else:
            raise SystemExit(128 + kind)
