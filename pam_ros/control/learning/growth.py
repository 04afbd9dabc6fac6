# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The bandwidth of the loop: it grows as far as the lag of the pressure allows.

A fast loop needs to know that the pressure follows fast. There are two ways to know it. What was
learned explains the force that the nominal model lacks, so that no other lag is in it. Or no force
is missing, as on a rig whose friction is configured, and the motion was fast enough to show how
long the lag is: the variance of its estimate has fallen. Then the bandwidth grows only as far as
the error asks for it, because a fast loop turns the noise of the sensor into pressure.
"""

from math import sqrt

from pam_ros.control.gains import Gains
from pam_ros.control.learning.learning_tuning import LearningTuning


class Growth:
    """The bandwidth in 1/s, between the two bandwidths of the gains."""

    def __init__(self, gains: Gains, tuning: LearningTuning) -> None:
        """Begin with the lower bandwidth; ``gains`` may be replaced later."""
        self.gains, self._tuning = gains, tuning
        self.bandwidth = gains.bandwidth
        self.start()

    def start(self) -> None:
        """Begin to watch the error."""
        self._square = self._asked = 0.0

    def see(self, dt: float, error: float, negligible: float) -> None:
        """Take in the *error* for *dt* s; what is below *negligible* asks for nothing."""
        self._square += min(dt / self._tuning.judge, 1.0) * (error * error - self._square)
        self._asked = min(max(sqrt(self._square) / negligible - 1.0, 0.0), 1.0)

    def follow(self, dt: float, lag: float, explained: float, known: float) -> None:
        """Approach for *dt* s what a *lag* in s allows.

        *explained* and *known*, 0 to 1: what the learned parameters explain of the missing force,
        and what of the uncertainty of the lag the motion has removed.
        """
        low, high = self.gains.bandwidth, self.gains.fast_bandwidth
        weight = max(explained, self._asked * known)
        allowed = max(self._tuning.margin * lag, 1.0 / high)
        decay = weight * allowed + (1.0 - weight) / low
        wanted = min(max(1.0 / decay, low), high)
        self.bandwidth += min(dt / self._tuning.grow, 1.0) * (wanted - self.bandwidth)
