# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Signals that ask for the end as KeyboardInterrupt, but never in the middle of rclpy's own work.

Raised while rclpy handles a message, it is lost in a destructor or comes out as another error.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from pam_ros.processes.ends import on_end


class _Interrupt:
    """What is known of it; there is one a process, as there is of signal handlers."""

    is_made = False
    is_held = False


def heed() -> None:
    """Let the first signal raise KeyboardInterrupt; later ones do no harm."""
    _Interrupt.is_made = False
    on_end(_note)


@contextmanager
def held_back() -> Iterator[None]:
    """Raise KeyboardInterrupt at the end of the context for what came before or during it.

    Before it, too: one that was raised in a destructor has been lost.
    """
    _Interrupt.is_held = True
    try:
        yield
    finally:
        _Interrupt.is_held = False
    if _Interrupt.is_made:
        raise KeyboardInterrupt


def _note(kind: int, frame: FrameType | None) -> None:
    if _Interrupt.is_made:
        return
    _Interrupt.is_made = True
    if not _Interrupt.is_held:
        raise KeyboardInterrupt
