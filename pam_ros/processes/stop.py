# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A program is asked to stop, by Ctrl-C or SIGTERM."""

import signal
from types import FrameType


class StopRequest:
    """Ctrl-C and SIGTERM, taken note of instead of raised: a second one does no harm."""

    def __init__(self) -> None:
        """Take over both signals."""
        self.is_made = False
        for kind in (signal.SIGINT, signal.SIGTERM):
            signal.signal(kind, self._note)

    def _note(self, kind: int, frame: FrameType | None) -> None:
        self.is_made = True
