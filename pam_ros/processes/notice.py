# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Inform the user of a task that takes long."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Timer


@contextmanager
def notice(seconds: float, inform: Callable[[], object]) -> Iterator[None]:
    """Call *inform* once, from another thread, if the context takes longer than *seconds*."""
    timer = Timer(seconds, inform)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
