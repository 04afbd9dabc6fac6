# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Conditions that last, as opposed to short ones."""


class Persistence:
    """Determines whether a condition that is checked repeatedly lasts."""

    def __init__(self, begin: int, end: int) -> None:
        """Set after how many checks in a row it starts to last (*begin*) and stops (*end*)."""
        self._begin, self._end = begin, end
        self.clear()

    def clear(self) -> None:
        """Remove the results of earlier checks: the condition does not last."""
        self.lasts = False
        self._count = 0  # checks in a row that contradict `lasts`

    def look(self, is_there: bool) -> bool:
        """Note whether the condition exists now; return whether it begins to last."""
        if is_there == self.lasts:
            self._count = 0
            return False
        self._count += 1
        if self._count < (self._end if self.lasts else self._begin):
            return False
        self.lasts, self._count = is_there, 0
        return is_there
