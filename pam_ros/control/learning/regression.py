# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recursive least squares with a prior and bounds: a Kalman filter of almost constant parameters.

Parameters that are estimated from a short motion are strongly correlated. If each were clamped to
its bounds, the others would not follow, and the prediction would be wrong by more than without
any parameter. Therefore the estimate without bounds is kept, and the parameters are its nearest
point within the bounds in the metric of its covariance: the most likely ones there (Simon 2010,
"Kalman filtering with state constraints", section 2.3). This quadratic programme is solved by
Hildreth's method (1957), which begins with the multipliers of the previous sample.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pam_ros.control.limits import clamp

Array = NDArray[np.float64]
SWEEPS = 20  # at most, over all parameters; the next sample continues from their end
CLOSE = 1e-3  # standard deviations: smaller changes of a parameter end the sweeps


def dot(a: Sequence[float], b: Sequence[float]) -> float:
    """Return the sum of the products in order, up to the end of the shorter one."""
    total = 0.0
    for x, y in zip(a, b, strict=False):
        total += x * y
    return total


class Regression:
    """Finds theta in y = phi . theta + noise, one sample after another.

    *spread* (n,) are the standard deviations of the prior of theta, *low* and *high* (n,) its
    physical limits, *noise* the variance of y. *correlation* (n, n) is that of the prior, none if
    it is not given. A parameter with a spread of 0 does not change.
    ``theta`` is a list, since a controller reads it much more often than it takes in a sample.
    """

    def __init__(
        self,
        spread: Array,
        low: Array,
        high: Array,
        noise: float,
        correlation: Array | None = None,
    ) -> None:
        """Begin with theta = 0."""
        self._prior = spread * spread
        self._correlation = correlation
        self._bounds = list(zip(low.tolist(), high.tolist(), strict=True))
        self._noise = noise
        self.theta = [0.0] * len(spread)
        self.covariance = self._correlated(self._prior)
        self._free = np.zeros(len(spread))  # the estimate without bounds
        self._multipliers = [0.0] * len(spread)

    def _correlated(self, variances: Array) -> Array:
        """Return the covariance of parameters with these *variances*, correlated as the prior."""
        if self._correlation is None:
            return np.diag(variances)
        spread = np.sqrt(variances)
        covariance: Array = self._correlation * (spread[:, None] * spread)
        return covariance

    def forget(self, parameter: int, value: float) -> None:
        """Let a *parameter* be *value*, with its prior, independent of the others."""
        self.theta[parameter] = self._free[parameter] = value
        self._multipliers[parameter] = 0.0
        self.covariance[parameter, :] = self.covariance[:, parameter] = 0.0
        self.covariance[parameter, parameter] = self._prior[parameter]

    def restart_from(self, other: 'Regression', parameters: slice) -> None:
        """Continue from the estimate of *other*, with the prior of these *parameters*.

        *other* keeps them at 0: its spread of them is 0.
        """
        self.theta, self._free = other.theta.copy(), other._free.copy()
        self._multipliers = other._multipliers.copy()
        self.covariance = other.covariance.copy()
        prior = self._correlated(self._prior)
        self.covariance[parameters, parameters] = prior[parameters, parameters]

    def uncertainty(self, parameters: slice) -> float:
        """Return the share of the prior variance that is left, of the least certain of these."""
        variances = np.diagonal(self.covariance)[parameters]
        return float(np.max(variances / self._prior[parameters]))

    def update(self, phi: Sequence[float], error: float, forgotten: float | Array) -> None:
        """Take in a sample whose y was *error* above phi . theta.

        *forgotten* is the share of the prior variance by which theta may have drifted since the
        last sample, one number for all or one for each parameter. The drift is correlated as the
        prior, and no variance becomes larger than its prior.
        """
        row = np.array(phi)
        direction = self.covariance @ row
        gain = direction / (self._noise + float(row @ direction))
        self._free += gain * (error + float(row @ (np.array(self.theta) - self._free)))
        self.covariance -= gain[:, None] * direction
        # A view, since functions that read a diagonal take as long as everything above.
        variances = self.covariance.reshape(-1)[:: len(phi) + 1]
        drift = np.minimum(forgotten * self._prior, self._prior - variances)
        drift = np.maximum(drift, 0.0)
        if self._correlation is None:
            variances += drift
        else:
            self.covariance += self._correlated(drift)
        self.theta = self._within_bounds(variances.tolist())

    def _within_bounds(self, variances: list[float]) -> list[float]:
        """Return the most likely parameters within the bounds."""
        multipliers = self._multipliers
        near = self._free + self.covariance @ np.array(multipliers)
        for _ in range(SWEEPS):
            is_close = True
            for n, ((low, high), variance) in enumerate(zip(self._bounds, variances, strict=True)):
                if variance == 0.0:
                    continue
                alone = near[n] - multipliers[n] * variance
                change = (clamp(alone, low, high) - alone) / variance - multipliers[n]
                if change == 0.0:
                    continue
                multipliers[n] += change
                near += change * self.covariance[n]
                is_close = is_close and change * change * variance < CLOSE * CLOSE
            if is_close:
                break
        pairs = zip(near.tolist(), self._bounds, strict=True)
        return [clamp(value, low, high) for value, (low, high) in pairs]
