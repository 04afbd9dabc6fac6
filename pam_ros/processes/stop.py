# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A program is asked to stop, by Ctrl-C or another signal that asks for the end."""

from types import FrameType

from pam_ros.processes.ends import on_end


class StopRequest:
    """Signals that ask for the end, noted instead of raised: a second one does no harm."""

    def __init__(self) -> None:
        """Take over these signals."""
        self.is_made = False
        on_end(self._note)

    def _note(self, kind: int, frame: FrameType | None) -> None:
        self.is_made = True
