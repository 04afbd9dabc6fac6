# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A request to stop a program, by Ctrl-C or another signal that requests the end."""

from types import FrameType

from pam_ros.processes.ends import on_end


class StopRequest:
    """Notes signals that request the end instead of raising: a second one has no effect."""

    def __init__(self) -> None:
        """Handle these signals from now on."""
        self.is_made = False
        on_end(self._note)

    def _note(self, kind: int, frame: FrameType | None) -> None:
        self.is_made = True
