# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""When a node logs that something is missing, and when it logs that it is back."""

from typing import Any

from pam_ros.health.health import Level

PATIENCE = 1.0  # s of waiting before it is written to the log


class Absence:
    """Logs one line when something is missing, and one line when it is there again.

    A publisher that is slower than a timeout is alternately missing and back. To keep the log
    short, it counts as back only if it has not been missing for longer than the timeout.
    """

    def __init__(
        self, logger: Any, back: str, patience: float = PATIENCE, level: Level = Level.OK
    ) -> None:
        """Write to *logger*, of rclpy, when something is missing for *patience* s.

        *level* is that of this line. The later line, *back*, has the level info.
        """
        self._logger, self._back = logger, back
        self._patience, self._level = patience, level
        self._is_missing = False  # according to the log
        self._since: float | None = None  # time in s since which the log is out of date
        self._times = 0

    def forget(self) -> None:
        """Begin again, without a line: nobody waits for it any more."""
        self._is_missing, self._since = False, None

    def look(self, missing: str, now: float, lasting: float = 0.0, times: int = 0) -> None:
        """Note the state at *now* s: *missing* is a sentence on what is missing, '' if nothing is.

        It counts as back after it has been there for *lasting* s without a change of *times*, the
        count of its absences. If time goes back, these seconds start again.
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
