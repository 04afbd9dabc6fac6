# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Reduce the feedback gains of a loop that oscillates.

A delay that the model does not have, such as that of a long hose, limits the gains: with higher
ones the loop oscillates. The delay itself is not known, but the oscillation can be detected
(:mod:`.oscillation`). Each one that is detected lowers the share of the feedback gains in
use. Without feedback the joint follows the model with its own stiffness and damping, which is
stable with any delay. Therefore a small enough share ends the oscillation. Whenever the share is
reduced, the law discards what it has learned, which may be the cause. Afterwards the share rises
slowly, because the rig may change.

If the oscillation lasts although hardly any feedback is left, its cause is outside the loop, such
as a vibration, and the share rises to 1 as soon as it ends.

An error that follows the motion of the reference is no oscillation of the loop. Therefore only
swings of the error count that are at least as large as the motion of the reference in the same
time.
"""

from dataclasses import dataclass
from math import exp, pi

from pam_ros.control.rest.oscillation import Oscillation, OscillationTuning
from pam_ros.control.tuning import number


@dataclass(frozen=True)
class ReductionTuning:
    """How the share of the gains falls and rises."""

    lower: float = number(
        0.5, '', 'times the share after an oscillation: one of them suffices for most delays'
    )
    least: float = number(
        0.05, '', 'lowest share: one muscle and a pair are stable with a dead time of 0.12 s'
    )
    forget: float = number(
        0.003,
        '1/s',
        'by which the share rises: a rig changes in minutes, and too large a share disturbs the '
        'motion',
    )
    quiet: float = number(1.0, 's', 'without a quick swing before it rises: three periods')
    restore: float = number(
        0.1,
        '1/s',
        'by which it rises if not the loop oscillated: slower than oscillations grow',
    )
    swung: float = number(
        1.0,
        '',
        'least swing of the error, divided by the distance that the reference moves in half a '
        'period: with 0.75, a light load that sticks and slips counts; control, friction, 5 kg',
    )
    memory: float = number(0.3, 's', 'in which the speed of the reference is forgotten: a period')


# A load that bounces on a stop, with 7 to 15 times the bandwidth, is no oscillation of the loop;
# with an unconfigured dead time of 30 to 80 ms the loop oscillates at 0.9 to 2.9 times (tests
# test_sliding_mode and test_unconfigured_delay).
OF_THE_LOOP = OscillationTuning(quickest=4.5)


class GainReduction:
    """The share of the feedback gains in use.

    share
        1 (all of them) to the least share

    Errors are in m, or in rad for a revolute joint.
    """

    def __init__(self, tuning: ReductionTuning) -> None:
        """Begin with the full gains."""
        self._tuning, self._oscillation = tuning, Oscillation(OF_THE_LOOP)
        self.start()
        self.reset()

    def start(self) -> None:
        """Begin again without an error; the share remains, because the delay does."""
        self._speed = 0.0
        self._oscillation.start(0.0)

    def reset(self) -> None:
        """Use the full gains again, because they are other ones."""
        self.share = self._bound = 1.0

    def see(self, dt: float, error: float, speed: float, least: float, bandwidth: float) -> bool:
        """Take in the *error* for *dt* s; return whether the share is reduced now.

        *speed* is that of the reference per second, *least* the least error that counts, and
        *bandwidth* that of the loop in rad/s.
        """
        tuning = self._tuning
        self._speed = max(abs(speed), self._speed * exp(-dt / tuning.memory))
        moved = self._speed * pi / bandwidth  # in half a period of the loop
        # Only swings of at least twice the given error count as an oscillation.
        counted = max(least, 0.5 * tuning.swung * moved)
        if self._oscillation.see(dt, error, counted, bandwidth, is_cut=False):
            return self._lower()
        self._bound = min(self._bound + tuning.forget * dt, 1.0)
        if self._oscillation.quiet > tuning.quiet and self.share < self._bound:
            self.share = min(self.share + tuning.restore * dt, self._bound)
        return False

    def _lower(self) -> bool:
        tuning = self._tuning
        if self.share > tuning.least:
            self.share = self._bound = max(tuning.lower * self.share, tuning.least)
            return True
        self._bound = 1.0  # the cause is outside the loop
        return False
