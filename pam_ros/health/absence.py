# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""When the log of a node says that something is missing, and when it says that it is back."""

from typing import Any

from pam_ros.health.health import Level

PATIENCE = 1.0  # s of waiting before it is written to the log


class Absence:
    """Writes one line when something is missing, and one line when it is there again.

    A publisher that is slower than a time-out is missing and back in turn. So that it does not
    fill the log, it counts as back only when it has not been missing for longer than the time-out.
    """

    def __init__(
        self, logger: Any, back: str, patience: float = PATIENCE, level: Level = Level.OK
    ) -> None:
        """Write to *logger*, of rclpy, when something is missing for *patience* s.

        *level* is that of the line then. The later line, *back*, is information.
        """
        self._logger, self._back = logger, back
        self._patience, self._level = patience, level
        self._is_missing = False  # as the log has it
        self._since: float | None = None  # since when it is otherwise, s
        self._times = 0

    def look(self, missing: str, now: float, lasting: float = 0.0, times: int = 0) -> None:
        """Note at *now* s that something is missing: the sentence *missing*; '' if it is there.

        It is back when it is there for *lasting* s, in which *times*, a count of its absences,
        does not change. A time that goes back begins these seconds again.
        """
        has_changed, self._times = times != self._times, times
        is_missing = bool(missing) or (self._is_missing and has_changed)
        if is_missing == self._is_missing:
            self._since = None
            return
        if self._since is None or now < self._since:
            self._since = now
        if now - self._since < (self._patience if is_missing else lasting):
            return
        self._is_missing, self._since = is_missing, None
        if not is_missing:
            self._logger.info(self._back)
        elif self._level is Level.OK:
            self._logger.info(missing)
        elif self._level is Level.WARN:  # rclpy allows one level for each line of the source
            self._logger.warning(missing)
        else:
            self._logger.error(missing)
