# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Changes while the reference rests: less bandwidth at the goal, faster loading of a stuck load.

A motion needs the full bandwidth. A load that rests at its goal needs almost none, and any
bandwidth turns the noise of the sensor into pressure. A load that sticks short of its goal acts as
a spring some hundred times as stiff as the muscle: an integral tuned for the muscle would take
minutes to load it. So the apparent stiffness of the load is measured here.
"""

from dataclasses import dataclass
from math import exp

from pam_ros.control.limits import clamp
from pam_ros.control.signals import Reference
from pam_ros.control.tuning import number


@dataclass(frozen=True)
class StandstillTuning:
    """When a reference counts as reached, and when a load counts as stuck."""

    after: float = number(
        0.5, 's', 'of resting reference before the motion counts as over: two periods of the load'
    )
    window: float = number(
        0.05, 's', 'average of the error: 25 samples bring the noise below half of the tolerance'
    )
    release: float = number(0.3, 's', 'in which the bandwidth falls: slower than the loop')
    full: float = number(
        2.5, '', 'times the tolerance: error at which the full bandwidth acts; control, at rest'
    )
    slow: float = number(0.2, 's', 'filter of the slopes of force and position: a period of 4 Hz')
    memory: float = number(0.3, 's', 'average of the products of the slopes')
    doubt: float = number(
        1.5, 'N', 'change of force below which nothing is concluded: control, friction at rest'
    )
    stiffest: float = number(
        20.0, '', 'largest stiffness, in muscles: faster loading overshoots; control, friction'
    )
    least_stiffness: float = number(
        1.0,
        'N/m',
        'least stiffness of the muscles, far below that of one: k is a divisor',
        along_muscle=False,
    )
    rest_speed: float = number(1e-4, 'm/s', 'below which a reference rests: 5 noises a second')
    rest_acceleration: float = number(1e-3, 'm/s^2', 'likewise: ten times that a second')


class Standstill:
    """Finds from reference, error and force how the load rests.

    factor
        0 (rests at the goal) to 1 (moves, or should move): a factor of all bandwidths
    stiffness
        apparent stiffness of the load over that of the muscles, at least 1
    """

    def __init__(self, tolerance: float, tuning: StandstillTuning) -> None:
        """Ignore an error of up to *tolerance*; *tuning* is in the joint's units."""
        self.tolerance, self._tuning = tolerance, tuning
        self.start()

    def set_tolerance(self, tolerance: float) -> None:
        """Ignore an error of up to *tolerance* from now on."""
        self.tolerance = tolerance

    def start(self) -> None:
        """Start again, at rest at the goal."""
        self.factor = 0.0
        self.stiffness = 1.0
        self._error = 0.0
        self._since = self._tuning.after
        self._is_new = True
        self._reset_slopes(0.0, 0.0)

    @property
    def is_moving(self) -> bool:
        """Whether the reference moves, or did until a moment ago."""
        return self._since < self._tuning.after

    def moves(self, reference: Reference) -> bool:
        """Return whether *reference* moves."""
        tuning = self._tuning
        return (
            abs(reference.velocity) > tuning.rest_speed
            or abs(reference.acceleration) > tuning.rest_acceleration
        )

    def see_error(self, dt: float, error: float, moves: bool) -> None:
        """Take in the raw *error* in m, and whether the reference *moves*."""
        self._since = 0.0 if moves else self._since + dt
        self._error += (1.0 - exp(-dt / self._tuning.window)) * (error - self._error)
        size = abs(self._error) / self.tolerance
        wanted = 1.0
        if not self.is_moving:
            wanted = clamp((size - 1.0) / (self._tuning.full - 1.0), 0.0, 1.0)
        if wanted > self.factor:
            self.factor = wanted
        else:
            self.factor += dt / self._tuning.release * (wanted - self.factor)

    def _reset_slopes(self, force: float, position: float) -> None:
        self._force, self._position = force, position
        self._force_slope = self._position_slope = 0.0
        self._power = self._product = 0.0

    def see_force(self, dt: float, force: float, position: float, stiffness: float) -> None:
        """Take in the wanted *force* in N, the *position* in m and the spring's k in N/m."""
        tuning = self._tuning
        if self.is_moving or self._is_new:
            self._is_new = False
            self._reset_slopes(force, position)
            self.stiffness = 1.0
            return
        share, kept = 1.0 - exp(-dt / tuning.slow), 1.0 - exp(-dt / tuning.memory)
        up, travel = force - self._force, position - self._position
        self._force += share * up
        self._position += share * travel
        self._force_slope += share * (up - self._force_slope)
        self._position_slope += share * (travel - self._position_slope)
        self._product += kept * (self._force_slope * self._position_slope - self._product)
        self._power += kept * (self._force_slope * self._force_slope - self._power)
        doubt = tuning.doubt * tuning.doubt
        k = max(stiffness, tuning.least_stiffness)
        compliance = (self._product + doubt / k) / (self._power + doubt)
        self.stiffness = clamp(1.0 / (k * max(compliance, 1e-12)), 1.0, tuning.stiffest)
