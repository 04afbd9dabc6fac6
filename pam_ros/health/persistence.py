# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Conditions that last, as opposed to those that come and go."""


class Persistence:
    """Says whether a condition that is looked at again and again lasts."""

    def __init__(self, begin: int, end: int) -> None:
        """Let it last from *begin* looks in a row that find it, until *end* that do not."""
        self._begin, self._end = begin, end
        self.clear()

    def clear(self) -> None:
        """Forget what was found."""
        self.lasts = False
        self._count = 0  # looks in a row that contradict `lasts`

    def look(self, is_there: bool) -> bool:
        """Note whether the condition is there now; return whether it begins to last."""
        if is_there == self.lasts:
            self._count = 0
            return False
        self._count += 1
        if self._count < (self._end if self.lasts else self._begin):
            return False
        self.lasts, self._count = is_there, 0
        return is_there
