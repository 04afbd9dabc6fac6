# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The bandwidth of the loop: it grows as far as the lag of the pressure allows.

A fast loop requires that the pressure follows fast. There are two kinds of evidence for that.
Either the effects that are learned and those that are fed forward explain the force that a model
without them lacks, so that it contains no other lag. Or no force is missing, and the motion was
fast enough to show how long the lag is: the variance of its estimate has fallen. In the second
case the bandwidth grows only as far as the error requires, because a fast loop turns the noise of
the sensor into pressure.
"""

from math import sqrt

from pam_ros.control.gains import Gains
from pam_ros.control.learning.learning_tuning import LearningTuning


class Growth:
    """The bandwidth in 1/s, between the two bandwidths of the gains."""

    def __init__(self, gains: Gains, tuning: LearningTuning) -> None:
        """Begin with the lower bandwidth."""
        self.gains, self._tuning = gains, tuning
        self.bandwidth = gains.bandwidth
        self.start()

    def set_gains(self, gains: Gains) -> None:
        """Continue between the bandwidths of other gains."""
        self.gains = gains

    def start(self) -> None:
        """Begin to average the error."""
        self._square = self._asked = 0.0

    def see(self, dt: float, error: float, negligible: float) -> None:
        """Take in the *error* for *dt* s; one below *negligible* requires no faster loop."""
        self._square += min(dt / self._tuning.judge, 1.0) * (error * error - self._square)
        self._asked = min(max(sqrt(self._square) / negligible - 1.0, 0.0), 1.0)

    def follow(self, dt: float, lag: float, explained: float, known: float) -> None:
        """Approach for *dt* s the bandwidth that a *lag* in s allows.

        *explained* is the share of the force of all effects that those learned and those fed
        forward explain, *known* the share of the uncertainty of the lag that the motion has
        removed; both are 0 to 1.
        """
        low, high = self.gains.bandwidth, self.gains.fast_bandwidth
        weight = max(explained, self._asked * known)
        allowed = max(self._tuning.margin * lag, 1.0 / high)
        decay = weight * allowed + (1.0 - weight) / low
        wanted = min(max(1.0 / decay, low), high)
        self.bandwidth += min(dt / self._tuning.grow, 1.0) * (wanted - self.bandwidth)
