# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A clock that never jumps, and that the test sets."""

from pam_ros.timing.pace import SECOND


class Steady:
    """Returns ``now``, a time in ns; each reading of it takes ``reading`` ns."""

    def __init__(self, now=5 * SECOND):
        """Start at the time *now*."""
        self.now, self.reading = now, 0

    def __call__(self):
        """Return the time."""
        self.now += self.reading
        return self.now
