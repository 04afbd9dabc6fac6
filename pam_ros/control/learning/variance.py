# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The variance of a force, sample after sample."""


class RunningVariance:
    """Variance of a force about its running mean, N^2; it begins at *first*."""

    def __init__(self, first: float) -> None:
        self.value = first
        self.start()

    def start(self) -> None:
        """Begin to average at the next force: an offset is no evidence of another effect."""
        self._centre: float | None = None

    def see(self, force: float, centring: float, share: float) -> None:
        """Take in a *force*, with its shares in the mean and in the variance."""
        centre = force if self._centre is None else self._centre
        self._centre = centre = centre + centring * (force - centre)
        self.value += share * ((force - centre) ** 2 - self.value)
