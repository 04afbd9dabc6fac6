# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The steps of a simulation at which samples of a given rate are due."""

import math
import sys


class Grid:
    """Samples of one rate, each at the first step that is not before it.

    They are counted from a step, never summed. ``next`` is the step of the next sample.
    """

    def __init__(self, steps: float) -> None:
        """Create it for this number of *steps* per simulated second; nothing is due yet."""
        self._steps = steps
        self.begin(0.0)

    def begin(self, rate: float, first: int = 0, sample: int = 0) -> None:
        """Count at *rate* in Hz from step *first* on; *sample* is the next one. Rate 0: never."""
        self._rate, self._first = rate, first
        self._aim(sample)

    def advance(self) -> None:
        """Continue with the sample after the next one."""
        self._aim(self._sample + 1)

    def _aim(self, sample: int) -> None:
        self._sample = sample
        self.next = sys.maxsize
        if self._rate:
            self.next = self._first + math.ceil(sample * self._steps / self._rate - 1e-9)
