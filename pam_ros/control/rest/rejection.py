# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How strongly disturbances are rejected: bandwidths that depend on the error of the load.

A fixed observer is a compromise between noise and stiffness: with a high bandwidth it turns the
noise of the sensor into pressure, with a low one a push moves the load. So the bandwidths are
scheduled by the error, as in the variable-gain control of wafer stages (Heertjes, Schuurbiers &
Nijmeijer 2009). The level is between 0, at which the load is calm, and 1, at which it is held as
firmly as the gains allow. It rises at once with the error of a load that should rest, and falls
slowly when the error has gone.

The level is limited by the delay between a command and its force, which may be unknown. If the
level is too high for this delay, the loop oscillates. Then the highest level is lowered
(:mod:`.gain_reduction`). While the load is disturbed without such an oscillation, the highest
level rises again, to below the level of the last oscillation.

After a motion of the reference the error is at first that of friction and hysteresis, which
:mod:`.standstill` and :mod:`.stiction` remove. The level begins to act when the error has been
below that of a disturbance for a moment, or when the load is shaken: a shaken load moves all the
time in both directions, while a load that sticks and slips moves for short times only.
"""

from dataclasses import dataclass
from math import copysign, exp, log, sqrt

from pam_ros.control.gains import Gains
from pam_ros.control.tuning import number


@dataclass(frozen=True)
class RejectionTuning:
    """When a load is disturbed, and how high the level may be."""

    window: float = number(0.02, 's', 'filter of the error: ten samples bring noise to a fifth')
    tolerances: float = number(
        2.0, '', 'rest tolerances that are no disturbance: beyond the 1.5 that stiction leaves'
    )
    noises: float = number(
        1.0, '', 'noises of the position that are none either: five times what the filter passes'
    )
    full: float = number(
        2.0, '', 'times the larger of both: error of the highest level; disturbance'
    )
    release: float = number(0.5, 's', 'in which the level falls: half a period of 1 Hz')
    memory: float = number(0.5, 's', 'average of the noise of the position: 250 samples')
    known: int = number(25, '', 'positions after which this noise is known to 15 %')
    first: float = number(
        12.3,
        'rad/s',
        'bandwidth of the observer at the highest level before anything is known of the delay: '
        'the loop is still stable with the unconfigured lag of 50/70 ms in the benchmark '
        'disturbance',
    )
    climb: float = number(
        0.25, '1/s', 'by which the highest level rises: an oscillation is found before it is large'
    )
    quiet: float = number(0.6, 's', 'without a quick swing before it rises: five swings long')
    lower: float = number(
        0.6, '', 'times the highest level after an oscillation: disturbance, lag'
    )
    below: float = number(
        0.85, '', 'times the level of an oscillation: bound of the next rise; disturbance, lag'
    )
    least: float = number(0.1, '', 'lowest value of the highest level: stable with those lags')
    forget: float = number(0.02, '1/s', 'by which that bound rises: a rig changes in minutes')
    calm: float = number(
        0.6, 's', 'without an error until a motion has ended: two rests between stiction pushes'
    )
    place: float = number(
        0.05, 's', 'filter of the error, for detecting that the load moves: a slip lasts as long'
    )
    shake: float = number(
        2.5, 's', 'average of this motion: longer than a loop with a lag rings; pair_control, lag'
    )
    shaken: float = number(
        0.7, '', 'share of the time for which a shaken load moves; a third in control, friction'
    )


class Rejection:
    """The level at which disturbances are rejected.

    level
        0 (calm) to ``highest``
    highest
        present upper limit of the level, at most 1
    error
        low-pass filtered error to the reference

    Errors and positions are in m, or in rad for a revolute joint.
    """

    def __init__(self, gains: Gains, tuning: RejectionTuning) -> None:
        """Start at rest."""
        self.gains, self._tuning = gains, tuning
        self.start()

    def set_gains(self, gains: Gains) -> None:
        """Continue with other gains."""
        self.gains = gains

    def start(self) -> None:
        """Start again at rest at the goal, without knowledge of the delay."""
        self.level, self.highest = 0.0, self._first_level()
        self._bound = 1.0
        self.error = 0.0
        self._last = (0.0, 0.0)  # the last two positions
        self._seen, self._variance = 0, 0.0
        self._begin_rest()
        self._acts = True

    def _first_level(self) -> float:
        """Return the level at which the observer has the bandwidth of the start."""
        calm, full = self.gains.observer_bandwidth, self.gains.rejection_bandwidth
        if full <= calm:
            return 1.0
        first = log(max(self._tuning.first / calm, 1.0)) / log(full / calm)
        return min(max(first, self._tuning.least), 1.0)

    @property
    def is_least(self) -> bool:
        """Whether the highest level is as low as it may be."""
        return self.highest <= self._tuning.least

    @property
    def noise(self) -> float:
        """The standard deviation of the measured positions, estimated at rest and in motion."""
        return sqrt(self._variance)

    @property
    def least_error(self) -> float:
        """The least error that counts as a disturbance of the load."""
        tuning = self._tuning
        return max(tuning.tolerances * self.gains.rest_tolerance, tuning.noises * self.noise)

    def between(self, calm: float, full: float) -> float:
        """Return the value at this level between *calm* at 0 and *full* at 1, logarithmically."""
        return calm if self.level == 0.0 else calm * (full / calm) ** self.level

    def see(
        self, dt: float, error: float, measured: float | None, *, moves: bool, quiet: float
    ) -> None:
        """Take in the *error* for *dt* s.

        *measured* is the position if there is a new one, *moves* whether the reference or the set
        stiffness moves, and *quiet* for how long there has been no sign of an oscillation, s.
        """
        tuning = self._tuning
        if measured is not None:
            self._see_noise(dt, measured)
        self.error += (1.0 - exp(-dt / tuning.window)) * (error - self.error)
        if moves or not self.gains.rejection:
            self._begin_rest()
            return
        least = self.least_error
        if self._seen < tuning.known:
            return
        if not self._acts:
            self._see_rest(dt, least)
            return
        self._follow(dt, abs(self.error) / least, quiet)

    def lower(self) -> None:
        """Lower the highest level, at which the loop oscillates."""
        tuning = self._tuning
        self._bound = max(tuning.below * self.highest, tuning.least)
        self.highest = max(tuning.lower * self.highest, tuning.least)
        self.level = min(self.level, self.highest)

    def _follow(self, dt: float, size: float, quiet: float) -> None:
        """Adapt the levels to an error of *size* times the least error of a disturbance."""
        tuning = self._tuning
        wanted = self.highest * min(max((size - 1.0) / (tuning.full - 1.0), 0.0), 1.0)
        if wanted >= self.level:
            self.level = wanted
        else:
            self.level += dt / tuning.release * (wanted - self.level)
            if self.level < 0.01:
                self.level = 0.0
        self._bound = min(self._bound + tuning.forget * dt, 1.0)
        is_used = self.level > 0.5 * self.highest
        if is_used and quiet > tuning.quiet and self.highest < self._bound:
            self.highest = min(self.highest + tuning.climb * dt, self._bound)

    def _see_noise(self, dt: float, measured: float) -> None:
        """Average the squares of second differences: for white noise six times its variance."""
        first, second = self._last
        self._last = second, measured
        self._seen += 1
        if self._seen < 3:
            return
        difference = measured - 2.0 * second + first
        # At first the mean of all samples, so that the estimate is right from the beginning.
        share = max(dt / self._tuning.memory, 1.0 / (self._seen - 2))
        self._variance += share * (difference * difference / 6.0 - self._variance)

    def _begin_rest(self) -> None:
        """Begin to evaluate the error after a motion; the level is 0 until this error has gone."""
        self.level, self._acts = 0.0, False
        self._calm = self._moving = self._direction = 0.0
        self._place = self.error

    def _see_rest(self, dt: float, least: float) -> None:
        """Find out whether the motion has ended, or the load is shaken."""
        tuning = self._tuning
        self._calm = self._calm + dt if abs(self.error) < least else 0.0
        self._place += (1.0 - exp(-dt / tuning.place)) * (self.error - self._place)
        offset = self.error - self._place
        side = 0.0 if abs(offset) < least else copysign(1.0, offset)
        share = 1.0 - exp(-dt / tuning.shake)
        self._moving += share * (abs(side) - self._moving)
        self._direction += share * (side - self._direction)
        both_ways = abs(self._direction) < 1.0 - tuning.shaken
        self._acts = self._calm > tuning.calm or (self._moving > tuning.shaken and both_ways)
