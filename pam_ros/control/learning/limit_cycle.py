# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Find an oscillation in which the command goes from one of its limits to the other.

If a rig changes suddenly, for example by a dead time, a loop that was fast before may become
unstable. The oscillation grows until the limits of pressure cut the command at both ends. Then
nothing more can be learned, because the pressures are not those that the law wants, and parameters
that were learned at the beginning of the oscillation, such as a long lag, sustain it.
"""

from math import copysign, exp

from pam_ros.control.learning.learning_tuning import LearningTuning


class LimitCycle:
    """Averages the shares of the time for which the command is cut above and below."""

    def __init__(self, tuning: LearningTuning) -> None:
        """Begin with a command that is not cut."""
        self._tuning = tuning
        self.start()

    def start(self) -> None:
        """Begin again."""
        self._side = self._above = self._below = 0.0

    def see(self, dt: float, cut: float) -> bool:
        """Return whether the command oscillates between its limits.

        In the last *dt* s a limit has cut off the part *cut* of the wanted effort, which may have
        either sign; it is 0 if the command is within its limits.
        """
        tuning = self._tuning
        # Noise at a limit cuts the command for single steps only, on alternating sides.
        side = copysign(1.0, cut) if cut != 0.0 else 0.0
        self._side += (1.0 - exp(-dt / tuning.cut)) * (side - self._side)
        share = min(dt / tuning.judge, 1.0)
        self._above += share * ((self._side > 0.5) - self._above)
        self._below += share * ((self._side < -0.5) - self._below)
        return min(self._above, self._below) > tuning.unstable
