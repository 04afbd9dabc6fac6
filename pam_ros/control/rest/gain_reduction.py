# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Reduce the feedback gains of a loop that oscillates.

A delay that the model does not have, such as that of a long hose, limits the gains: with higher
ones the loop oscillates. The delay itself is not known, but the oscillation can be detected
(:mod:`.oscillation`). Without feedback the joint follows the model with its own stiffness and
damping, which is stable with any delay. So a lower share of the feedback gains ends the
oscillation. Whenever the share is reduced, the law discards what it has learned, which may be the
cause. Afterwards the share rises slowly, because the rig may change.

A periodic force on the load looks the same, and less feedback makes its motion larger. So each
oscillation is followed by a test with the least share (:mod:`.cause`). If the loop was the cause,
the share is reduced. If the cause is outside, the share returns, except if the motion with
feedback was as large as without; then a lower share is used as long as this force lasts. The
swing without feedback is kept as well: larger ones show that the feedback adds to it.

While disturbances are rejected, their level (:mod:`.rejection`) is what makes the loop oscillate.
It is reduced first, without a test, because the load would leave its place in the test.

An error that follows the motion of the reference is no oscillation of the loop. Therefore only
swings of the error count that are at least as large as the motion of the reference in the same
time.
"""

from dataclasses import dataclass
from enum import Enum
from math import exp, inf, pi

from pam_ros.control.rest.cause import CauseTest, CauseTuning
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
    restore: float = number(
        1.0, '1/s', 'by which it returns after a test: in three periods of a slow load'
    )
    helps: float = number(
        0.9, '', 'times the swing without feedback, below which the feedback is of use'
    )
    larger: float = number(
        1.15, '', 'times the swing without feedback, above which the feedback adds to it'
    )
    fades: float = number(
        30.0, 's', 'in which that swing is forgotten: each test lets the load move for a moment'
    )
    quiet: float = number(1.0, 's', 'without a quick swing, after which a force has ended')
    swung: float = number(
        1.0,
        '',
        'least swing of the error, divided by the distance that the reference moves in half a '
        'period: with 0.75, a light load that sticks and slips counts; control, friction, 5 kg',
    )
    memory: float = number(0.3, 's', 'in which the speed of the reference is forgotten: a period')


class Cause(Enum):
    """What can make the loop oscillate."""

    SHARE = 'the feedback gains'
    LEVEL = 'the level at which disturbances are rejected'


class GainReduction:
    """The share of the feedback gains in use.

    share
        1 (all of them) to the least share

    Errors and swings are in m, or in rad for a revolute joint.
    """

    def __init__(self, tuning: ReductionTuning) -> None:
        """Begin with the full gains."""
        self._tuning, self._oscillation = tuning, Oscillation(OscillationTuning())
        self.reset()
        self.start()

    def start(self) -> None:
        """Begin again without an error; the share remains, because the delay does."""
        self._speed = 0.0
        self._oscillation.start()
        self.share = self._bound
        self._begin()

    def reset(self) -> None:
        """Use the full gains again, because they are other ones."""
        self.share = self._bound = 1.0  # at present, and at most: after oscillations of the loop
        self._begin()

    def _begin(self) -> None:
        """Begin without a test and without a force from outside."""
        self._test: CauseTest | None = None
        self._outside = 0.0  # swing without feedback under a force from outside
        self._useful = 1.0  # largest share that is of use against this force

    @property
    def quiet(self) -> float:
        """For how long there has been no sign of an oscillation of the loop, s."""
        returns = self.share < min(self._bound, self._useful)
        if self._test is not None or returns or self._oscillation.is_rising:
            return 0.0
        if self._outside == 0.0:
            return self._oscillation.quiet
        return 0.0 if self._is_larger else inf

    @property
    def _is_larger(self) -> bool:
        """Whether the last swing is larger than those without feedback."""
        return self._oscillation.swing > self._tuning.larger * self._outside

    def see(
        self,
        dt: float,
        error: float,
        speed: float,
        least: float,
        bandwidth: float,
        *,
        suspect: Cause = Cause.SHARE,
        is_cut: bool = False,
        is_disturbed: bool = False,
    ) -> Cause | None:
        """Take in the *error* for *dt* s; return what made the loop oscillate, if anything did.

        *speed* is that of the reference per second, *least* the least error that counts,
        *bandwidth* that of the loop in rad/s. *suspect* is what would make the loop oscillate
        now: the share is reduced here, the level is not. *is_cut* is whether a limit cuts the
        command, and *is_disturbed* whether a disturbance is rejected.
        """
        tuning, oscillation = self._tuning, self._oscillation
        self._speed = max(abs(speed), self._speed * exp(-dt / tuning.memory))
        moved = self._speed * pi / bandwidth  # in half a period of the loop
        # Only swings of at least twice the given error count as an oscillation.
        counted = max(least, 0.5 * tuning.swung * moved)
        known = oscillation.count
        oscillates = oscillation.see(dt, error, counted, bandwidth, is_cut=is_cut)
        swing = oscillation.swing if oscillation.count > known else None
        self._bound = min(self._bound + tuning.forget * dt, 1.0)
        if self._test is not None:
            cause = self._test.see(dt, swing, pi / bandwidth)
            return None if cause is None else self._conclude(self._test.before, cause)
        self._forget_force(dt, is_disturbed=is_disturbed)
        adds = self._outside > 0.0 and swing is not None and swing > 2.0 * counted
        is_found = (oscillates or adds) and self._is_larger
        if is_found or (oscillates and oscillation.has_grown):
            if suspect is Cause.LEVEL:
                return suspect
            if self.share > tuning.least:
                self._tested, self.share = self.share, tuning.least
                self._test = CauseTest(CauseTuning(), oscillation.swing)
                return None
        highest = min(self._bound, self._useful)
        self.share = max(min(self.share + tuning.restore * dt, highest), tuning.least)
        return None

    def _forget_force(self, dt: float, *, is_disturbed: bool) -> None:
        """Forget the force from outside slowly, or at once when the load has become quiet."""
        tuning = self._tuning
        self._outside *= exp(-dt / tuning.fades)
        if self._oscillation.quiet > tuning.quiet and not is_disturbed:
            self._outside, self._useful = 0.0, 1.0

    def _conclude(self, before: float, outside: float) -> Cause | None:
        """End the test: the swing was *before* with feedback, and is *outside* without.

        The latter is 0 if the loop was the cause.
        """
        tuning = self._tuning
        self._test, self._outside = None, outside
        lower = max(tuning.lower * self._tested, tuning.least)
        if outside == 0.0 and self._useful < self._bound:
            self._useful = 1.0  # the force has ended in the test
            return None
        if outside == 0.0:
            self.share = self._bound = lower
            return Cause.SHARE
        if before > tuning.helps * outside:
            self._useful = lower
        return None
