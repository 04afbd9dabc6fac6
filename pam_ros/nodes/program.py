# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How a node's program starts: signals first, then what takes time to import.

So that Ctrl-C and SIGTERM end a program cleanly from its first tenth of a second on.
"""

import gc
import signal
import sys
from importlib import import_module
from types import FrameType
from typing import NoReturn


class StopRequest:
    """Ctrl-C and SIGTERM, taken note of instead of raised: a second one does no harm."""

    def __init__(self) -> None:
        """Take over both signals."""
        self.is_made = False
        for kind in (signal.SIGINT, signal.SIGTERM):
            signal.signal(kind, self._note)

    def _note(self, kind: int, frame: FrameType | None) -> None:
        self.is_made = True


def start_node(module: str, name: str, about: str) -> NoReturn:
    """Run the node class *name* of *module* until it is asked to stop; exit with its code.

    *about* is what ``--help`` shows.
    """
    stop = StopRequest()
    # What is imported stays: looking for garbage in it would take a fifth of the start.
    gc.disable()
    spin = import_module('pam_ros.nodes.spin')
    node = getattr(import_module(module), name)
    sys.exit(spin.run(node, stop, about))
