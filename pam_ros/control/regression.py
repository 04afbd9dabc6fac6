# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recursive least squares with a prior: a Kalman filter of parameters that hardly change."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Regression:
    """Finds theta in y = phi . theta + noise, one sample after another.

    *spread* (n,) are the standard deviations of the prior of theta, *low* and *high* (n,) its
    physical limits, *noise* the variance of y. A parameter with a spread of 0 does not change.
    """

    def __init__(self, spread: Array, low: Array, high: Array, noise: float) -> None:
        """Begin with theta = 0."""
        self._prior = spread * spread
        self._low, self._high, self._noise = low, high, noise
        self.theta = np.zeros(len(spread))
        self.covariance = np.diag(self._prior)

    def update(self, phi: Array, error: float, forgotten: float | Array) -> None:
        """Take in a sample whose y was *error* above phi . theta.

        *forgotten* is the share of the prior variance by which theta may have drifted since the
        last sample, one number for all or one for each parameter.
        """
        direction = self.covariance @ phi
        gain = direction / (self._noise + phi @ direction)
        self.theta = np.clip(self.theta + gain * error, self._low, self._high)
        self.covariance -= np.outer(gain, direction)
        diagonal = self.covariance.diagonal() + forgotten * self._prior
        np.fill_diagonal(self.covariance, np.minimum(diagonal, self._prior))
