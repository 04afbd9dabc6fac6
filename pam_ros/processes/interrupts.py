# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Raise KeyboardInterrupt for signals that request the end, but never within rclpy's own work.

A KeyboardInterrupt that is raised while rclpy handles a message is lost in a destructor, or it
appears as another error.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from pam_ros.processes.ends import on_end


class _Interrupt:
    """The state of the interrupt; there is one per process, as for signal handlers."""

    is_made = False
    is_held = False


def raise_on_signal() -> None:
    """Let the first signal raise KeyboardInterrupt; later ones have no effect."""
    _Interrupt.is_made = False
    on_end(_note)


@contextmanager
def held_back() -> Iterator[None]:
    """Raise KeyboardInterrupt at the end of the context for a signal before or during it.

    A signal before it counts, too: a KeyboardInterrupt that was raised in a destructor has been
    lost.
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
