# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What sets the pace of a program that commands a rig: its own rate, or the states of the rig."""

from abc import ABC
from collections.abc import Callable
from enum import Enum, auto
from typing import ClassVar

from pam_ros.timing.pace import SECOND

REPEAT = SECOND // 20  # ns after a command, after which it is sent again for a repeated state


class Reply(Enum):
    """What a program does when it receives a state."""

    NONE = auto()
    COMMAND = auto()  # it computes and sends a command
    LAST_COMMAND = auto()  # it sends its last command again


class Pacing(ABC):
    """What sets the pace of a program that commands a rig.

    With ``answers_states`` time follows the stamps of the states, and each new state is answered
    with one command; otherwise the program commands at its own rate, on the wall clock.
    """

    answers_states: ClassVar[bool]

    def __init__(self, steady: Callable[[], int]) -> None:
        """Begin without a command; *steady* returns ns of a clock that never jumps."""
        self._steady = steady
        self._commanded = 0

    @property
    def keeps_wall_time(self) -> bool:
        """Whether the program keeps a rate on the wall clock."""
        return not self.answers_states

    @property
    def since_command(self) -> int:
        """Time in ns since the last command."""
        return self._steady() - self._commanded

    def note_command(self) -> None:
        """Note that a command is sent now."""
        self._commanded = self._steady()

    def reply_to_state(self, *, is_repeated: bool) -> Reply:
        """Return what a state leads to; *is_repeated* means that it was received before."""
        if not self.answers_states:
            return Reply.NONE
        if not is_repeated:
            return Reply.COMMAND
        # In lockstep a state is published again if the answer to it was not received.
        return Reply.LAST_COMMAND if self.since_command > REPEAT else Reply.NONE
