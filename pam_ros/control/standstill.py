# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What changes when the reference rests: calm at the goal, and patience with stiction.

A motion needs all the bandwidth there is. A load that rests where it shall needs next to none, and
what there is turns the noise of the sensor into pressure. And a load that sticks short of its
goal is a spring some hundred times as stiff as the muscle: an integral tuned for the muscle would
take minutes to load it. So this measures the stiffness that the load shows.
"""

from math import exp

AFTER = 0.5  # s of resting reference before the motion counts as over
WINDOW = 0.05  # s over which the error is averaged
RELEASE = 0.3  # s in which the bandwidth falls
FULL = 2.5  # times the tolerance: error at which the full bandwidth acts
SLOW, MEMORY = 0.2, 0.3  # s, for the slopes of force and position and for what they show
DOUBT = 1.5  # N, change of force below which nothing is concluded
STIFFEST = 20.0


class Standstill:
    """Reads from reference, error and force how the load rests.

    factor
        0 (rests where it shall) to 1 (moves, or shall): what all bandwidths go with
    stiffness
        how many times stiffer than the muscle the load shows itself, 1 to STIFFEST
    """

    def __init__(self, tolerance: float) -> None:
        """Count an error of *tolerance* m as none."""
        self.tolerance = tolerance
        self.start()

    def start(self) -> None:
        """Begin anew, at rest at the goal."""
        self.factor = 0.0
        self.stiffness = 1.0
        self._error = 0.0
        self._since = AFTER
        self._is_new = True
        self._reset_slopes(0.0, 0.0)

    @property
    def is_moving(self) -> bool:
        """Whether the reference moves, or did until a moment ago."""
        return self._since < AFTER

    def see_error(self, dt: float, error: float, moves: bool) -> None:
        """Take in the raw *error* in m, and whether the reference *moves*."""
        self._since = 0.0 if moves else self._since + dt
        self._error += (1.0 - exp(-dt / WINDOW)) * (error - self._error)
        size = abs(self._error) / self.tolerance
        wanted = 1.0 if self.is_moving else min(max((size - 1.0) / (FULL - 1.0), 0.0), 1.0)
        if wanted > self.factor:
            self.factor = wanted
        else:
            self.factor += dt / RELEASE * (wanted - self.factor)

    def _reset_slopes(self, force: float, position: float) -> None:
        self._force, self._position = force, position
        self._force_slope = self._position_slope = 0.0
        self._power = self._product = 0.0

    def see_force(self, dt: float, force: float, position: float, stiffness: float) -> None:
        """Take in the wanted *force* in N, the *position* in m and the muscle's k in N/m."""
        if self.is_moving or self._is_new:
            self._is_new = False
            self._reset_slopes(force, position)
            self.stiffness = 1.0
            return
        share, kept = 1.0 - exp(-dt / SLOW), 1.0 - exp(-dt / MEMORY)
        up, way = force - self._force, position - self._position
        self._force += share * up
        self._position += share * way
        self._force_slope += share * (up - self._force_slope)
        self._position_slope += share * (way - self._position_slope)
        self._product += kept * (self._force_slope * self._position_slope - self._product)
        self._power += kept * (self._force_slope * self._force_slope - self._power)
        doubt = DOUBT * DOUBT
        k = max(stiffness, 1.0)
        compliance = (self._product + doubt / k) / (self._power + doubt)
        self.stiffness = min(max(1.0 / (k * max(compliance, 1e-12)), 1.0), STIFFEST)
