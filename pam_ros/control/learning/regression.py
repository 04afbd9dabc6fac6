# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recursive least squares with a prior: a Kalman filter of parameters that hardly change."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pam_ros.control.limits import clamp

Array = NDArray[np.float64]


def dot(a: Sequence[float], b: Sequence[float]) -> float:
    """Return the sum of the products in order, up to the end of the shorter one."""
    total = 0.0
    for x, y in zip(a, b, strict=False):
        total += x * y
    return total


class Regression:
    """Finds theta in y = phi . theta + noise, one sample after another.

    *spread* (n,) are the standard deviations of the prior of theta, *low* and *high* (n,) its
    physical limits, *noise* the variance of y. A parameter with a spread of 0 does not change.
    ``theta`` is a list, since a controller asks for it much more often than it takes in a sample.
    """

    def __init__(self, spread: Array, low: Array, high: Array, noise: float) -> None:
        """Begin with theta = 0."""
        self._prior = spread * spread
        self._bounds = list(zip(low.tolist(), high.tolist(), strict=True))
        self._noise = noise
        self.theta = [0.0] * len(spread)
        self.covariance = np.diag(self._prior)

    def forget(self, parameter: int, value: float) -> None:
        """Let a *parameter* be *value*, with its prior, independent of the others."""
        self.theta[parameter] = value
        self.covariance[parameter, :] = self.covariance[:, parameter] = 0.0
        self.covariance[parameter, parameter] = self._prior[parameter]

    def update(self, phi: Sequence[float], error: float, forgotten: float | Array) -> None:
        """Take in a sample whose y was *error* above phi . theta.

        *forgotten* is the share of the prior variance by which theta may have drifted since the
        last sample, one number for all or one for each parameter.
        """
        direction = self.covariance @ np.array(phi)
        gain = direction / (self._noise + dot(phi, direction.tolist()))
        self.theta = [
            clamp(old + each * error, low, high)
            for old, each, (low, high) in zip(self.theta, gain.tolist(), self._bounds, strict=True)
        ]
        self.covariance -= gain[:, None] * direction
        # A view: functions that fill a diagonal take as long as all of the above.
        diagonal = self.covariance.reshape(-1)[:: len(phi) + 1]
        np.minimum(diagonal + forgotten * self._prior, self._prior, out=diagonal)
